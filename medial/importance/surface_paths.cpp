#include "surface_paths.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "../applications/divided_mesh.h"

namespace orchard::detail {
namespace {

// More landmarks make the search for a path shorter, and the bound at each vertex dearer.
constexpr std::size_t kLandmarks = 16;
constexpr float kFar = std::numeric_limits<float>::infinity();

float apart(const Point& a, const Point& b) { return static_cast<float>((a - b).norm()); }

// The length of the straight line from `a` to `b` after the triangles (p, q, a) and (q, p, b) have been unfolded into a
// plane; infinite if it leaves them.
float across(const Point& p, const Point& q, const Point& a, const Point& b) {
  const Vector edge = q - p;
  const double length = edge.norm();
  if (!(length > 0)) return kFar;
  const double xa = (a - p).dot(edge) / length, xb = (b - p).dot(edge) / length;
  const double ya = std::sqrt(std::max((a - p).squaredNorm() - xa * xa, 0.0));
  const double yb = std::sqrt(std::max((b - p).squaredNorm() - xb * xb, 0.0));
  if (!(ya + yb > 0)) return kFar;
  const double crossing = (xa * yb + xb * ya) / (ya + yb);
  return crossing >= 0 && crossing <= length ? static_cast<float>(std::hypot(xb - xa, ya + yb)) : kFar;
}

}  // namespace

SurfacePaths::SurfacePaths(const Surface& surface, double max_edge) {
  DividedMesh divided = divided_mesh(surface, max_edge);
  mesh_ = std::move(divided.mesh);
  of_triangle_ = std::move(divided.of_triangle);
  add_arcs();
  add_landmarks();
}

void SurfacePaths::add_arcs() {
  struct Side {
    Index low, high, opposite;
    auto operator<=>(const Side&) const = default;  // NOLINT(modernize-use-nullptr): no 0 here
  };
  struct Way {
    Index from, to;
    float length;
    auto operator<=>(const Way&) const = default;  // NOLINT(modernize-use-nullptr): no 0 here
  };
  std::vector<Side> sides;
  for (const auto& corners : mesh_.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = corners[i], b = corners[(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), corners[(i + 2) % 3]});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Way> ways;
  const auto& at = mesh_.vertices;
  const auto add = [&](Index a, Index b, float length) {
    if (!(length < kFar)) return;
    ways.push_back({a, b, length});
    ways.push_back({b, a, length});
  };
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    const auto [p, q, opposite] = sides[i];
    while (next < sides.size() && sides[next].low == p && sides[next].high == q) ++next;
    add(p, q, apart(at[p], at[q]));
    if (next == i + 2)
      add(opposite, sides[i + 1].opposite, across(at[p], at[q], at[opposite], at[sides[i + 1].opposite]));
  }
  std::sort(ways.begin(), ways.end());
  first_arc_.assign(at.size() + 1, 0);
  for (const Way& way : ways) {
    arcs_.push_back({way.to, way.length});
    ++first_arc_[way.from + 1];
  }
  for (std::size_t v = 0; v < at.size(); ++v) first_arc_[v + 1] += first_arc_[v];
}

std::vector<float> SurfacePaths::distances_from(Index landmark) const {
  std::vector<float> lengths(mesh_.vertices.size(), kFar);
  std::vector<std::pair<float, Index>> heap{{0.0F, landmark}};
  lengths[landmark] = 0;
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>());
    const auto [length, vertex] = heap.back();
    heap.pop_back();
    if (length > lengths[vertex]) continue;
    for (Index arc = first_arc_[vertex]; arc < first_arc_[vertex + 1]; ++arc) {
      const float longer = length + arcs_[arc].length;
      if (!(longer < lengths[arcs_[arc].to])) continue;
      lengths[arcs_[arc].to] = longer;
      heap.emplace_back(longer, arcs_[arc].to);
      std::push_heap(heap.begin(), heap.end(), std::greater<>());
    }
  }
  return lengths;
}

// Each landmark is the vertex that is farthest from those before; one that they do not reach at all comes first, so
// that every component of the surface has one while there are enough.
void SurfacePaths::add_landmarks() {
  const std::size_t count = mesh_.vertices.size();
  std::vector<float> nearest(count, kFar);
  std::vector<std::vector<float>> columns;
  while (columns.size() < std::min(kLandmarks, count)) {
    const auto farthest = static_cast<Index>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    columns.push_back(distances_from(farthest));
    for (std::size_t v = 0; v < count; ++v) nearest[v] = std::min(nearest[v], columns.back()[v]);
  }
  landmarks_ = columns.size();
  to_landmarks_.reserve(landmarks_ * count);
  for (std::size_t v = 0; v < count; ++v) {
    for (const std::vector<float>& column : columns) to_landmarks_.push_back(column[v]);
  }
}

// Finds the part of the surface's triangle that the place lies in.
SurfacePaths::Place SurfacePaths::locate(const ClosestPoint& place) const {
  const auto [first, last] = std::equal_range(of_triangle_.begin(), of_triangle_.end(), place.triangle);
  Place result;
  result.position = place.position;
  double nearest = std::numeric_limits<double>::infinity();
  for (auto part = first; part != last; ++part) {
    const auto triangle = static_cast<Index>(part - of_triangle_.begin());
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const auto& at = mesh_.vertices;
    const double distance =
        (closest_point_of_triangle(place.position, at[a], at[b], at[c]).position - place.position).squaredNorm();
    if (!(distance < nearest)) continue;
    nearest = distance;
    result.triangle = triangle;
  }
  result.corners = mesh_.triangles[result.triangle];
  for (std::size_t i = 0; i < 3; ++i) result.lengths[i] = apart(place.position, mesh_.vertices[result.corners[i]]);
  return result;
}

// A lower bound on the length of a path in the graph from a vertex to a place.
float SurfacePaths::at_least(Index vertex, const Place& to) const {
  const float* own = &to_landmarks_[vertex * landmarks_];
  float result = kFar;
  for (std::size_t i = 0; i < 3; ++i) {
    const float* other = &to_landmarks_[to.corners[i] * landmarks_];
    float longest = 0;
    for (std::size_t k = 0; k < landmarks_; ++k) {
      const float difference = std::abs(own[k] - other[k]);
      if (own[k] < kFar || other[k] < kFar) longest = std::max(longest, difference);
    }
    result = std::min(result, longest + to.lengths[i]);
  }
  return result;
}

double SurfacePaths::length(const ClosestPoint& from, const ClosestPoint& to, Search& search) const {
  if (from.triangle == to.triangle) return (from.position - to.position).norm();
  const Place start = locate(from), goal = locate(to);
  ++search.run_;
  search.heap_.clear();
  const auto reach = [&](Index vertex, float length) {
    if (search.marks_[vertex] == search.run_ && !(length < search.lengths_[vertex])) return;
    search.marks_[vertex] = search.run_;
    search.lengths_[vertex] = length;
    const float whole = length + at_least(vertex, goal);
    if (!(whole < kFar)) return;
    search.heap_.push_back({whole, length, vertex});
    std::push_heap(search.heap_.begin(), search.heap_.end());
  };
  for (std::size_t i = 0; i < 3; ++i) reach(start.corners[i], start.lengths[i]);
  float best = kFar;
  while (!search.heap_.empty()) {
    std::pop_heap(search.heap_.begin(), search.heap_.end());
    const Search::Entry entry = search.heap_.back();
    search.heap_.pop_back();
    if (entry.at_least >= best) break;
    if (entry.length > search.lengths_[entry.vertex]) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      if (goal.corners[i] == entry.vertex) best = std::min(best, entry.length + goal.lengths[i]);
    }
    for (Index arc = first_arc_[entry.vertex]; arc < first_arc_[entry.vertex + 1]; ++arc)
      reach(arcs_[arc].to, entry.length + arcs_[arc].length);
  }
  return best;
}

}  // namespace orchard::detail
