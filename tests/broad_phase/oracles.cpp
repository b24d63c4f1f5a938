#include "oracles.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::test {

std::vector<BodyPair> touching_pairs(std::span<const Motion> motions) {
  std::vector<BodyIndex> order(motions.size());
  for (BodyIndex i = 0; i < order.size(); ++i) order[i] = i;
  const auto begin = [&](BodyIndex i) { return motions[i].position[0] - motions[i].radius; };
  const auto end = [&](BodyIndex i) { return motions[i].position[0] + motions[i].radius; };
  std::sort(order.begin(), order.end(), [&](BodyIndex i, BodyIndex j) { return begin(i) < begin(j); });
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double last = end(order[i]) + 1e-9 * (1 + std::fabs(end(order[i])));  // for rounding
    for (std::size_t j = i + 1; j < order.size() && begin(order[j]) <= last; ++j) {
      const Motion &a = motions[order[i]], &b = motions[order[j]];
      const double dx = a.position[0] - b.position[0], dy = a.position[1] - b.position[1],
                   dz = a.position[2] - b.position[2], reach = a.radius + b.radius;
      if (dx * dx + dy * dy + dz * dz > reach * reach) continue;
      pairs.push_back({std::min(order[i], order[j]), std::max(order[i], order[j])});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace orchard::runtime::test
