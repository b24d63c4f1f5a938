#include "tangent_touch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace orchard::detail {
namespace {

// A ray that passes a corner or an edge within this margin counts as meeting it, so that no ray passes between two
// triangles because of rounding.
constexpr double kOnTriangleBorder = 1e-12;  // of the triangle's area
constexpr double kOutside = 1e-10;  // of a squared radius: far more than the roundings of a distance from the centre
constexpr double kFarLarger = 1e8;  // of a squared radius, beside a squared distance

void take(Touch& best, const TangentPlace& place, const Point& at) {
  const Vector way = place.position - at;
  const double depth = place.normal.dot(way);
  if (!(depth > 0)) return;
  const double radius = way.squaredNorm() / (2 * depth);
  if (radius < best.radius) best = {radius, at};
}

bool is_in_cone(const TangentPlace& place, const Point& q) {
  const Vector way = place.position - q;
  const double depth = place.normal.dot(way);
  return depth > 0 && depth >= place.sine * way.norm();
}

bool is_in_triangle(const Point& q, const std::array<Point, 3>& corners, const Vector& normal, double slack = 0) {
  for (int i = 0; i < 3; ++i) {
    const Point &a = corners[static_cast<std::size_t>(i)], &b = corners[static_cast<std::size_t>((i + 1) % 3)];
    if ((b - a).cross(q - a).dot(normal) < -slack) return false;
  }
  return true;
}

struct Interval {
  double begin, end;
};

// Returns the part of the segment a + t e, t in [0, 1], that lies in the cone. It is an interval, since the cone is
// convex.
std::optional<Interval> part_in_cone(const TangentPlace& place, const Point& a, const Vector& e) {
  const bool first = is_in_cone(place, a), last = is_in_cone(place, a + e);
  if (first && last) return Interval{0, 1};
  const Vector way = place.position - a;
  const double depth = place.normal.dot(way), slope = place.normal.dot(e), sine2 = place.sine * place.sine;
  const double qa = slope * slope - sine2 * e.squaredNorm(), qb = depth * slope - sine2 * way.dot(e),
               qc = depth * depth - sine2 * way.squaredNorm();
  const double discriminant = qb * qb - qa * qc;
  std::array<double, 2> roots{};
  std::size_t count = 0;
  if (discriminant >= 0) {
    const double sum = qb + std::copysign(std::sqrt(discriminant), qb);
    for (const double root : {qa != 0 ? sum / qa : -1, sum != 0 ? qc / sum : -1}) {
      if (root > 0 && root < 1 && depth - root * slope > 0) roots[count++] = root;
    }
    if (count == 2 && roots[1] < roots[0]) std::swap(roots[0], roots[1]);
  }
  if (first) return Interval{0, count > 0 ? roots[0] : 0};
  if (last) return Interval{count > 0 ? roots[count - 1] : 1, 1};
  if (count < 2) return std::nullopt;
  return Interval{roots[0], roots[1]};
}

// Whether no place of an edge makes a ball smaller than `limit`: those that do lie inside the ball of this radius, up
// to rounding.
bool is_edge_outside(const TangentPlace& place, const Point& a, const Point& b, double limit) {
  // Of a ball that is far larger than the distance, or infinite, the margin leaves nothing to test.
  if (!(limit * limit < kFarLarger * (place.position - a).squaredNorm())) return false;
  const Vector e = b - a, way = place.position - limit * place.normal - a;
  const double squared = e.squaredNorm();
  const double t = squared > 0 ? std::clamp(way.dot(e) / squared, 0.0, 1.0) : 0;
  return (way - t * e).squaredNorm() >= limit * limit * (1 + kOutside);
}

// Tries the places of an edge. Along a line the radius falls and then rises, so within the cone it is least at the
// place nearest to its minimum.
void take_edge(Touch& best, const TangentPlace& place, const Point& a, const Point& b) {
  const Vector e = b - a, way = place.position - a;
  const double squared = e.squaredNorm();
  if (!(squared > 0)) return;
  const std::optional<Interval> part = part_in_cone(place, a, e);
  if (!part) return;
  const double along = way.dot(e) / squared, slope = place.normal.dot(e) / squared;
  const Vector across = way - along * e, turned = place.normal - slope * e;
  const double product = across.dot(turned), distance2 = across.squaredNorm();
  const double denominator = product + std::sqrt(product * product + slope * slope * squared * distance2);
  // If no ball touches the line, the radius falls towards the place of the line that is nearest to p.
  const double radius = denominator > 0 ? distance2 / denominator : 0;
  const double t = std::clamp(along - radius * slope, part->begin, part->end);
  take(best, place, a + t * e);
}

// Returns the place of a plane inside the cone that the smallest ball touches. `height` is that of p above the plane,
// above 0.
Point lowest_of_plane(const TangentPlace& place, const Vector& up, double height) {
  const double cosine = place.normal.dot(up);
  if ((1 + cosine) / 2 >= place.sine * place.sine) return place.position - height / (1 + cosine) * (place.normal + up);
  // The ball would touch the plane outside the cone, so the place is on the border of the cone, in the steepest
  // direction down to the plane.
  const Vector level = (up - cosine * place.normal).normalized();
  const Vector down = -place.sine * place.normal - std::sqrt(1 - place.sine * place.sine) * level;
  const double steepness = -down.dot(up);
  return steepness > 0 ? Point(place.position + height / steepness * down) : place.position;
}

}  // namespace

Touch touch_of_triangle(const TangentPlace& place, const std::array<Point, 3>& corners, const Vector& normal,
                        double limit) {
  Touch best;
  const double height = normal.dot(place.position - corners[0]);
  if (height != 0) {
    const Vector up = height > 0 ? normal : Vector(-normal);
    if (std::abs(height) >= limit * (1 + place.normal.dot(up))) return best;  // the whole plane is too far
    const Point lowest = lowest_of_plane(place, up, std::abs(height));
    if (is_in_triangle(lowest, corners, normal)) {
      take(best, place, lowest);
      return best;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &a = corners[i], &b = corners[(i + 1) % 3];
    if (!is_edge_outside(place, a, b, std::min(limit, best.radius))) take_edge(best, place, a, b);
  }
  return best;
}

Touch ray_through_triangle(const TangentPlace& place, const std::array<Point, 3>& corners, const Vector& normal) {
  const double slope = normal.dot(place.normal);
  if (slope == 0) return {};
  const double way = normal.dot(place.position - corners[0]) / slope;
  const Point at = place.position - way * place.normal;
  const double area2 = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  if (!(way > 0) || !is_in_triangle(at, corners, normal, kOnTriangleBorder * area2)) return {};
  return {way / 2, at};
}

double descent_at(const Vector& place_normal, const std::array<Point, 3>& corners, const Vector& normal,
                  Feature feature) {
  const auto down = [&](const Vector& way) { return way.isZero(0) ? 0.0 : -place_normal.dot(way) / way.norm(); };
  const Vector steepest = place_normal.dot(normal) * normal - place_normal;
  if (feature == Feature::face) return steepest.norm();
  const bool at_edge = feature <= Feature::edge2;
  const auto i =
      static_cast<std::size_t>(feature) - static_cast<std::size_t>(at_edge ? Feature::edge0 : Feature::vertex0);
  const Vector next = corners[(i + 1) % 3] - corners[i], last = corners[(i + 2) % 3] - corners[i];
  if (at_edge) {
    if (next.cross(steepest).dot(normal) >= 0) return steepest.norm();
    return std::abs(down(next));
  }
  const bool between = next.cross(steepest).dot(normal) >= 0 && steepest.cross(last).dot(normal) >= 0;
  return between ? steepest.norm() : std::max(down(next), down(last));
}

}  // namespace orchard::detail
