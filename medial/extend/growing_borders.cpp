#include "growing_borders.h"

#include <algorithm>
#include <tuple>

namespace orchard::detail {

GrowingBorders::GrowingBorders(const SheetExtension& sheets, double reach)
    : sheets_(sheets), reach_(reach), ends_(reach) {
  for (const Index e : sheets.borders) add_edge(sheets.complex.edges[e]);
}

void GrowingBorders::add_edge(const std::array<Index, 2>& edge) {
  if (++triangles_at_[key(edge)] > 1) return;
  for (const Index v : edge) ends_.add(sheets_.complex.balls[v].center, static_cast<Index>(edges_.size()));
  edges_.push_back(edge);
}

void GrowingBorders::add(Index a, Index b, Index c) {
  for (const auto& edge : {std::array{a, b}, std::array{b, c}, std::array{a, c}}) add_edge(edge);
}

bool GrowingBorders::has(const std::array<Index, 2>& edge) const {
  const auto at = triangles_at_.find(key(edge));
  return at != triangles_at_.end() && at->second == 1;
}

std::vector<std::array<Index, 2>> GrowingBorders::near(const Point& place) const {
  std::vector<std::tuple<double, Index, Index>> found;
  ends_.visit_near(place, [&](Index i) {
    auto [a, b] = edges_[i];
    const auto way = [&](Index v) { return (sheets_.complex.balls[v].center - place).norm(); };
    if (way(b) < way(a)) std::swap(a, b);
    if (way(a) > reach_ || !has(edges_[i])) return;
    const double side = (sheets_.complex.balls[a].center - sheets_.complex.balls[b].center).norm();
    found.emplace_back(way(a) + way(b) - side, a, b);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(found.size());
  for (const auto& [longer, a, b] : found) edges.push_back({a, b});
  return edges;
}

}  // namespace orchard::detail
