#include "sheet_way.h"

#include <algorithm>
#include <functional>
#include <map>
#include <queue>
#include <utility>

namespace orchard::detail {
namespace {

constexpr double kMaxDetour = 2;  // in lengths, plus as many spacings: the longest path

}  // namespace

std::vector<Index> way_between(const SheetExtension& sheets, std::span<const Index> from, std::span<const Index> to,
                               double length) {
  struct Reached {
    double length;
    Index from;
  };
  const double limit = kMaxDetour * (length + sheets.options.spacing);
  std::map<Index, Reached> reached;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue;
  const auto offer = [&](Index v, double way, Index before) {
    if (way > limit) return;
    const auto [at, is_new] = reached.try_emplace(v, Reached{way, before});
    if (!is_new && at->second.length <= way) return;
    at->second = {way, before};
    queue.emplace(way, v);
  };
  for (const Index v : from) offer(v, 0, kNone);
  while (!queue.empty()) {
    const auto [way, v] = queue.top();
    queue.pop();
    if (way > reached.at(v).length) continue;
    if (std::find(to.begin(), to.end(), v) != to.end()) {
      std::vector<Index> found;
      for (Index at = v; at != kNone; at = reached.at(at).from) found.push_back(at);
      std::reverse(found.begin(), found.end());
      return found;
    }
    for (const Index e : sheets.at.edges_at[v]) {
      const Index next = sheets.other_end(e, v);
      const ExactBall &a = sheets.complex.balls[v], &b = sheets.complex.balls[next];
      if (b.radius > 0) offer(next, way + (a.center - b.center).norm(), v);
    }
  }
  return {};
}

}  // namespace orchard::detail
