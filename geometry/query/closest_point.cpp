#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

// A point of a triangle as seen from the query.
struct Foot {
  Vector offset;  // from the query; its length keeps its digits where the position's rounding would swamp it
  double squared = 0;
  Point position;
  Feature feature = Feature::face;
};

Foot at_vertex(const Vector& offset, const Point& vertex, Feature feature) {
  return {offset, offset.squaredNorm(), vertex, feature};
}

// The nearest point of the edge from corner i, whose ends are p and q, or a and b as seen from the query. Both
// triangles at an edge get the same bits out of it, whatever the direction in which they run along it. A foot within
// `snap` of an end is that end.
Foot on_edge(const Point& p, const Point& q, const Vector& a, const Vector& b, int i, double snap) {
  const auto start = static_cast<Feature>(static_cast<int>(Feature::vertex0) + i);
  const auto end = static_cast<Feature>(static_cast<int>(Feature::vertex0) + (i + 1) % 3);
  const Vector edge = b - a;
  const double to_end = -a.dot(edge), to_start = b.dot(edge);  // weights of the ends
  if (!(to_end > 0)) return at_vertex(a, p, start);
  if (!(to_start > 0)) return at_vertex(b, q, end);
  const double sum = to_end + to_start;
  const Vector offset = a * (to_start / sum) + b * (to_end / sum);
  if ((offset - a).squaredNorm() <= snap * snap) return at_vertex(a, p, start);
  if ((offset - b).squaredNorm() <= snap * snap) return at_vertex(b, q, end);
  const Point position = to_end < to_start ? Point(p + edge * (to_end / sum)) : Point(q - edge * (to_start / sum));
  return {offset, offset.squaredNorm(), position, static_cast<Feature>(static_cast<int>(Feature::edge0) + i)};
}

// Of how far the corners are: a foot in the interior that is farther than this from the edges is nearer than they are,
// whatever was rounded (a dozen roundings of 1.1e-16, squared roots of which matter: 1e-8 and room).
constexpr double kClear = 1e-5;

// The nearest point of a triangle's plane, by its longest edge and the height over it, which stays accurate on needles.
struct PlaneFoot {
  PlaneFoot(const std::array<Point, 3>& corners, const std::array<Vector, 3>& seen) {
    std::size_t longest = 0;
    double base_squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double squared = (corners[(i + 1) % 3] - corners[i]).squaredNorm();
      if (squared > base_squared || i == 0) longest = i, base_squared = squared;
    }
    const Vector& start = seen[longest];
    const Vector base = corners[(longest + 1) % 3] - corners[longest];
    const Vector side = corners[(longest + 2) % 3] - corners[longest];
    const double foot_of_apex = side.dot(base) / base_squared;
    Vector height = side - foot_of_apex * base;
    height -= (height.dot(base) / base_squared) * base;
    const double height_squared = height.squaredNorm();
    const double x = -start.dot(base) / base_squared, y = -start.dot(height) / height_squared;
    const double weight = x - foot_of_apex * y;  // of the end of the base; y is the apex's
    const double least = std::min({y, weight, 1 - weight - y});
    inside = y > 0 && weight > 0 && weight + y < 1;  // false for NaN: no area
    if (!inside) return;
    const Vector shift = x * base + y * height;
    foot = {start + shift, 0, corners[longest] + shift, Feature::face};
    foot.squared = foot.offset.squaredNorm();
    // No other height is less than that over the longest edge.
    to_edges_squared = least * least * height_squared;
    size_squared = base_squared + start.squaredNorm();
  }

  Foot foot;
  bool inside = false;
  double to_edges_squared = 0;  // the foot's squared distance to the edges, at least
  double size_squared = 0;      // of the triangle, and of how far it is
};

}  // namespace

// The edges are measured too, but where the foot in the plane is clearly inside, so a poor one cannot hide a better
// one.
ClosestPoint closest_point_of_triangle(const Point& query, const Point& a, const Point& b, const Point& c) {
  const std::array<Point, 3> corners{a, b, c};
  const std::array<Vector, 3> seen{a - query, b - query, c - query};
  const auto max = [](const Point& p) { return p.cwiseAbs().maxCoeff(); };
  // What rounding the coordinates can move a point by: nearer feet than that are told apart by nothing.
  const double snap = 8 * std::numeric_limits<double>::epsilon() * std::max({max(query), max(a), max(b), max(c)});

  const PlaneFoot in_plane(corners, seen);
  const auto result = [](const Foot& foot) {
    return ClosestPoint{foot.position, std::sqrt(foot.squared), kNone, foot.feature};
  };
  if (in_plane.to_edges_squared > std::max(kClear * kClear * in_plane.size_squared, 16 * snap * snap))
    return result(in_plane.foot);
  Foot best = on_edge(a, b, seen[0], seen[1], 0, snap);
  for (std::size_t i = 1; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Foot foot = on_edge(corners[i], corners[j], seen[i], seen[j], static_cast<int>(i), snap);
    if (foot.squared < best.squared) best = foot;
  }
  const bool is_inside = in_plane.inside && in_plane.foot.squared < best.squared &&
                         (in_plane.foot.offset - best.offset).squaredNorm() > snap * snap;
  return result(is_inside ? in_plane.foot : best);
}

}  // namespace orchard
