#include "coalesce.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/grid_cell.h"

namespace orchard::detail {

std::vector<Index> representatives_of_coincident(std::span<const Point> points, double distance) {
  if (points.empty()) return {};
  DisjointSets sets(points.size());

  // The cells are so wide that few points have to look beyond their own, and so narrow that few share one. A sorted
  // list of hashes needs no buckets; equal hashes of different cells do no harm, since the distance decides.
  const double size = 64 * distance;
  Point origin = points[0];
  for (const Point& point : points) origin = origin.cwiseMin(point);
  std::vector<std::pair<std::uint64_t, Index>> entries(points.size());
  for (Index i = 0; i < points.size(); ++i) entries[i] = {hash_of(grid_cell(points[i] - origin, size)), i};
  std::sort(entries.begin(), entries.end());

  const auto unite_if_near = [&](Index a, Index b) {
    if ((points[a] - points[b]).squaredNorm() <= distance * distance) sets.unite(a, b);
  };
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto [hash, i] = entries[k];
    for (std::size_t other = k + 1; other < entries.size() && entries[other].first == hash; ++other) {
      unite_if_near(i, entries[other].second);
    }
    const GridCell low = grid_cell(points[i] - Vector::Constant(distance) - origin, size);
    const GridCell high = grid_cell(points[i] + Vector::Constant(distance) - origin, size);
    if (low == high) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const GridCell cell{corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]};
      const std::pair<std::uint64_t, Index> first{hash_of(cell), 0};
      if (first.first == hash) continue;
      auto entry = std::lower_bound(entries.begin(), entries.end(), first);
      for (; entry != entries.end() && entry->first == first.first; ++entry) unite_if_near(i, entry->second);
    }
  }
  std::vector<Index> lowest(points.size());
  for (Index i = 0; i < lowest.size(); ++i) lowest[i] = sets.root(i);
  return lowest;
}

}  // namespace orchard::detail
