#include "medial_parts.h"

#include <algorithm>
#include <utility>

namespace orchard::detail {
namespace {

// The number of nearest points that count as adjacent to a point without adjacent ones.
constexpr std::size_t kNearPoints = 6;

}  // namespace

Parts vertex_parts(const MedialAxis& axis, const std::vector<Index>& vertices, const std::vector<Index>& wanted,
                   PartScratch& scratch) {
  Parts parts;
  std::vector<Index> used;
  for (Index p : wanted) scratch.wanted[p] = 1;
  for (Index v : vertices) {
    std::vector<Index> points;
    for (Index p : axis.forming_points[v])
      if (scratch.wanted[p]) points.push_back(p);
    if (points.empty()) continue;
    scratch.part_of[v] = static_cast<Index>(parts.spheres.size());
    used.push_back(v);
    parts.spheres.push_back({axis.centers[v], axis.radii[v]});
    parts.points.push_back(std::move(points));
  }
  for (Index v : used)
    for (Index neighbor : axis.neighbors[v])
      if (v < neighbor && scratch.part_of[neighbor] != kNone)
        parts.adjacent.push_back({scratch.part_of[v], scratch.part_of[neighbor]});
  for (Index v : used) scratch.part_of[v] = kNone;
  for (Index p : wanted) scratch.wanted[p] = 0;
  return parts;
}

Parts point_parts(const MedialAxis& axis, const std::vector<Index>& points) {
  Parts parts;
  const auto count = static_cast<Index>(points.size());
  std::vector<std::pair<double, Index>> near;
  for (Index i = 0; i < count; ++i) {
    const Point& here = axis.points[points[i]];
    parts.spheres.push_back({here, 0});
    parts.points.push_back({points[i]});
    near.clear();
    for (Index k = 0; k < count; ++k)
      if (k != i) near.emplace_back((axis.points[points[k]] - here).squaredNorm(), k);
    const auto some = static_cast<std::ptrdiff_t>(std::min(kNearPoints, near.size()));
    std::partial_sort(near.begin(), near.begin() + some, near.end());
    for (std::ptrdiff_t k = 0; k < some; ++k) {
      const Index other = near[static_cast<std::size_t>(k)].second;
      parts.adjacent.push_back({std::min(i, other), std::max(i, other)});
    }
  }
  std::sort(parts.adjacent.begin(), parts.adjacent.end());
  parts.adjacent.erase(std::unique(parts.adjacent.begin(), parts.adjacent.end()), parts.adjacent.end());
  return parts;
}

}  // namespace orchard::detail
