#include "same_place.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace orchard {

using Triangle = std::array<Index, 3>;

std::vector<Index> first_at_place(const TriangleMesh& mesh) {
  std::vector<Index> order(mesh.vertices.size()), first(mesh.vertices.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::iota(first.begin(), first.end(), Index{0});
  const auto place = [&](Index v) {
    const Point& p = mesh.vertices[v];
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::make_pair(place(a), a) < std::make_pair(place(b), b); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (place(order[i]) == place(order[i - 1])) first[order[i]] = first[order[i - 1]];
  return first;
}

std::pair<Triangle, bool> canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  const bool reversed = t[1] > t[2];
  if (reversed) std::swap(t[1], t[2]);
  return {t, reversed};
}

std::vector<std::vector<Index>> same_corners(const TriangleMesh& mesh) {
  std::vector<std::pair<Triangle, Index>> sorted;
  for (Index t = 0; t < mesh.triangles.size(); ++t) sorted.emplace_back(canonical(mesh.triangles[t]).first, t);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::vector<Index>> groups;
  for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
    while (last < sorted.size() && sorted[last].first == sorted[first].first) ++last;
    if (last - first == 1) continue;
    auto& group = groups.emplace_back();
    for (std::size_t i = first; i < last; ++i) group.push_back(sorted[i].second);
  }
  return groups;
}

}  // namespace orchard
