#include "opened_link.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace orchard::detail {
namespace {

constexpr std::size_t kMaxCollapses = 8;  // with more of them, a whole sheet would be lost for one vertex

// Returns a common neighbour of both ends that forms no triangle with them, or kNone. A contraction would merge the two
// edges to it, although these need not be homotopic.
Index obstruction(const ContractibleMesh& mesh, Index a, Index b) {
  std::vector<Index> common, filled;
  std::set_intersection(mesh.neighbors(a).begin(), mesh.neighbors(a).end(), mesh.neighbors(b).begin(),
                        mesh.neighbors(b).end(), std::back_inserter(common));
  mesh.opposite(a, b, filled);
  const auto found = std::find_if(common.begin(), common.end(),
                                  [&](Index v) { return std::find(filled.begin(), filled.end(), v) == filled.end(); });
  return found == common.end() ? kNone : *found;
}

// Removes the triangles at the edge from a to w, and the edge. Returns false if that is impossible. Appends the removed
// cells in both cases.
bool take_edge(ContractibleMesh& mesh, Index a, Index w, std::pair<Index, Index> kept, std::vector<Collapse>& taken) {
  std::vector<Index> thirds;
  while (taken.size() < kMaxCollapses) {
    mesh.opposite(a, w, thirds);
    if (thirds.empty()) return false;
    if (thirds.size() == 1) {
      taken.push_back({a, w, mesh.collapse(a, w)});
      return true;
    }
    bool found = false;
    for (const Index x : thirds) {
      for (const Index end : {a, w}) {
        if (std::minmax(end, x) == std::minmax(kept.first, kept.second)) continue;
        if (mesh.count_triangles_at(end, x) != 1) continue;
        taken.push_back({end, x, mesh.collapse(end, x)});
        found = true;
        break;
      }
      if (found) break;
    }
    if (!found) return false;
  }
  return false;
}

}  // namespace

std::optional<std::vector<Collapse>> open_link(ContractibleMesh& mesh, Index a, Index b) {
  std::vector<Collapse> taken;
  while (!mesh.may_contract(a, b)) {
    const Index w = obstruction(mesh, a, b);
    std::vector<Collapse> best;
    for (const Index end : {a, b}) {
      if (w == kNone) break;
      std::vector<Collapse> way = taken;
      const bool found = take_edge(mesh, end, w, {a, b}, way);
      undo(mesh, std::span(way).subspan(taken.size()));
      if (found && (best.empty() || way.size() < best.size())) best = std::move(way);
    }
    if (best.empty()) {
      undo(mesh, taken);
      return std::nullopt;
    }
    for (std::size_t i = taken.size(); i < best.size(); ++i) mesh.collapse(best[i].a, best[i].b);
    taken = std::move(best);
  }
  return taken;
}

void undo(ContractibleMesh& mesh, std::span<const Collapse> collapses) {
  for (std::size_t i = collapses.size(); i-- > 0;) mesh.expand(collapses[i].a, collapses[i].b, collapses[i].c);
}

}  // namespace orchard::detail
