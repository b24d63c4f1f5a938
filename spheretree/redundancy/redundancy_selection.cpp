#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "orchard/spheretree/redundancy.h"

namespace orchard {
namespace {

using Links = std::vector<std::vector<Index>>;

// rests_on[i] lists the redundant nodes, by their positions in the list, that node i rests on.
Links links_between(std::span<const RedundantNode> redundant) {
  std::unordered_map<Index, Index> place;  // used for look-up only, never iterated
  for (Index i = 0; i < redundant.size(); ++i) place.emplace(redundant[i].node, i);
  Links rests_on(redundant.size());
  for (Index i = 0; i < redundant.size(); ++i)
    for (Index coverer : redundant[i].coverers)
      if (const auto found = place.find(coverer); found != place.end() && found->second != i)
        rests_on[i].push_back(found->second);
  return rests_on;
}

// Finds a cycle among the nodes that are not kept, by depth-first search. It is empty if there is none.
class CycleFinder {
 public:
  CycleFinder(const Links& links, const std::vector<char>& kept)
      : links_(links), kept_(kept), state_(links.size(), State::unseen) {}

  std::vector<Index> find() {
    for (Index i = 0; i < links_.size(); ++i)
      if (!kept_[i] && state_[i] == State::unseen && search(i)) return cycle_;
    return {};
  }

 private:
  enum class State : char { unseen, on_path, done };

  bool search(Index node) {
    state_[node] = State::on_path;
    path_.push_back(node);
    for (Index next : links_[node]) {
      if (kept_[next] || state_[next] == State::done) continue;
      if (state_[next] == State::on_path) {
        cycle_.assign(std::find(path_.begin(), path_.end(), next), path_.end());
        return true;
      }
      if (search(next)) return true;
    }
    path_.pop_back();
    state_[node] = State::done;
    return false;
  }

  const Links& links_;
  const std::vector<char>& kept_;
  std::vector<State> state_;
  std::vector<Index> path_, cycle_;
};

std::vector<Index> nodes_not(const std::vector<char>& kept, std::span<const RedundantNode> redundant) {
  std::vector<Index> nodes;
  for (Index i = 0; i < redundant.size(); ++i)
    if (!kept[i]) nodes.push_back(redundant[i].node);
  return nodes;
}

}  // namespace

std::vector<Index> independent_selection(std::span<const RedundantNode> redundant) {
  const Links rests_on = links_between(redundant);
  Links joined(redundant.size());  // the undirected graph
  for (Index i = 0; i < rests_on.size(); ++i)
    for (Index other : rests_on[i]) {
      joined[i].push_back(other);
      joined[other].push_back(i);
    }
  for (auto& row : joined) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  std::vector<Index> order(redundant.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return joined[a].size() < joined[b].size(); });
  std::vector<char> kept(redundant.size(), 1);
  for (Index i : order)
    if (std::all_of(joined[i].begin(), joined[i].end(), [&](Index other) { return kept[other]; })) kept[i] = 0;
  return nodes_not(kept, redundant);
}

std::vector<Index> acyclic_selection(std::span<const RedundantNode> redundant) {
  const Links rests_on = links_between(redundant);
  std::vector<char> kept(redundant.size(), 0);
  while (true) {
    const std::vector<Index> cycle = CycleFinder(rests_on, kept).find();
    if (cycle.empty()) return nodes_not(kept, redundant);
    std::vector<Index> load(redundant.size(), 0);  // the number of removed nodes that rest on each node
    for (Index i = 0; i < rests_on.size(); ++i)
      if (!kept[i])
        for (Index other : rests_on[i]) ++load[other];
    kept[*std::max_element(cycle.begin(), cycle.end(),
                           [&](Index a, Index b) { return load[a] != load[b] ? load[a] < load[b] : a > b; })] = 1;
  }
}

}  // namespace orchard
