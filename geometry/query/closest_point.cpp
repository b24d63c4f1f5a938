#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

// A point of a triangle as seen from the query.
struct Foot {
  Vector offset;  // from the query; it is accurate even where the position itself is rounded too coarsely
  double squared = 0;
  Point position;
  Feature feature = Feature::face;
};

Foot at_vertex(const Vector& offset, const Point& vertex, Feature feature) {
  return {offset, offset.squaredNorm(), vertex, feature};
}

// Returns the nearest point of the edge from corner i. The ends of the edge are p and q, and a and b are these relative
// to the query. The result has the same bits for both triangles at an edge, whatever the direction of the edge in them.
// A foot within `snap` of an end is that end.
Foot on_edge(const Point& p, const Point& q, const Vector& a, const Vector& b, int i, double snap) {
  const auto start = static_cast<Feature>(static_cast<int>(Feature::vertex0) + i);
  const auto end = static_cast<Feature>(static_cast<int>(Feature::vertex0) + (i + 1) % 3);
  const Vector edge = b - a;
  const double to_end = -a.dot(edge), to_start = b.dot(edge);  // the weights of the ends
  if (!(to_end > 0)) return at_vertex(a, p, start);
  if (!(to_start > 0)) return at_vertex(b, q, end);
  const double sum = to_end + to_start;
  const Vector offset = a * (to_start / sum) + b * (to_end / sum);
  if ((offset - a).squaredNorm() <= snap * snap) return at_vertex(a, p, start);
  if ((offset - b).squaredNorm() <= snap * snap) return at_vertex(b, q, end);
  const Point position = to_end < to_start ? Point(p + edge * (to_end / sum)) : Point(q - edge * (to_start / sum));
  return {offset, offset.squaredNorm(), position, static_cast<Feature>(static_cast<int>(Feature::edge0) + i)};
}

// A fraction of the distance of the corners. A foot in the interior that is farther than this from the edges is nearer
// to the query than they are, in spite of rounding. (A dozen roundings of 1.1e-16 in squares are 1e-8 in lengths, plus
// a margin.)
constexpr double kClear = 1e-5;

// The point of a triangle's plane that is nearest to the query. It is computed from the longest edge and the height
// above it, which is accurate for needles, too.
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
    // The height above the longest edge is the smallest of the three.
    to_edges_squared = least * least * height_squared;
    size_squared = base_squared + start.squaredNorm();
  }

  Foot foot;
  bool inside = false;
  double to_edges_squared = 0;  // a lower bound on the squared distance of the foot to the edges
  double size_squared = 0;      // of the triangle and its distance
};

}  // namespace

// The edges are measured, too, unless the foot in the plane is clearly inside, so that an inaccurate foot does not hide
// a better one.
ClosestPoint closest_point_of_triangle(const Point& query, const Point& a, const Point& b, const Point& c) {
  const std::array<Point, 3> corners{a, b, c};
  const std::array<Vector, 3> seen{a - query, b - query, c - query};
  const auto max = [](const Point& p) { return p.cwiseAbs().maxCoeff(); };
  // The distance by which rounding of coordinates may move a point. Feet that are nearer than this to each other cannot
  // be distinguished.
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
