#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "quality_parts.h"

namespace orchard::detail {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr double kPrecision = 1e-3;  // of the distance to the second contact
// Times the radius: the second contact of a medial ball is expected within this distance.
constexpr double kLikely = 1.02;
constexpr double kTinyBall = 1e-6;  // of the diagonal: the contacts of smaller balls are dominated by rounding

// Finds the nearest point, outside a cone around the first contact, of triangles that are given one after the other.
class ContactSearch {
 public:
  // Looks only for points that are nearer than `limit`.
  ContactSearch(const Point& center, const Vector& direction, double angle, double limit)
      : center_(center), direction_(direction), cosine_(std::cos(angle)), nearest_(limit) {}

  double nearest() const { return nearest_; }
  double limit() const { return (1 - kPrecision) * nearest_; }  // points farther than this are not searched for

  // The cone is convex, so a piece whose corners are inside it lies inside and is skipped. If a piece crosses the cone,
  // its nearest point counts if that is outside the cone; otherwise both halves are examined.
  void look_at(const Point& a, const Point& b, const Point& c) {
    if (in_cone(a) && in_cone(b) && in_cone(c)) return;
    const ClosestPoint closest = closest_point_of_triangle(center_, a, b, c);
    if (closest.distance >= limit()) return;
    if (!in_cone(closest.position)) {
      nearest_ = closest.distance;
      return;
    }
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    const double longest = std::max({ab, bc, ca});
    if (longest <= std::pow(kPrecision * closest.distance, 2)) {
      for (const Point& corner : {a, b, c}) {
        if (!in_cone(corner)) nearest_ = std::min(nearest_, (corner - center_).norm());
      }
      return;
    }
    if (ab == longest) return look_at_halves(a, b, c);
    if (bc == longest) return look_at_halves(b, c, a);
    look_at_halves(c, a, b);
  }

 private:
  void look_at_halves(const Point& a, const Point& b, const Point& c) {
    const Point middle = 0.5 * (a + b);
    look_at(a, middle, c);
    look_at(middle, b, c);
  }
  bool in_cone(const Point& point) const {
    const Vector way = point - center_;
    return way.dot(direction_) > cosine_ * way.norm();
  }

  Point center_;
  Vector direction_;
  double cosine_;
  double nearest_;
};

}  // namespace

double second_contact_distance(const Surface& surface, const Point& center, const Vector& direction, double angle,
                               double likely) {
  for (const double limit : {likely, std::numeric_limits<double>::infinity()}) {
    ContactSearch search(center, direction, angle, limit);
    surface.visit_nearest(center, [&](Index triangle) {
      const auto [a, b, c] = surface.corners(triangle);
      search.look_at(a, b, c);
      return search.limit();
    });
    if (search.nearest() < limit) return search.nearest();
  }
  return std::numeric_limits<double>::infinity();
}

double off_centre(const Surface& surface, const Sphere& ball, const ClosestPoint& first, double min_contact_angle,
                  double diagonal) {
  if (!(ball.radius > kTinyBall * diagonal) || !(first.distance > 0)) return kUndefined;
  const Vector direction = (first.position - ball.center) / first.distance;
  const double second = second_contact_distance(surface, ball.center, direction, min_contact_angle,
                                                kLikely * std::max(ball.radius, first.distance));
  return std::isfinite(second) ? std::abs(second - ball.radius) / ball.radius : kUndefined;
}

void measure_contacts(const Surface& surface, std::span<const Sphere> balls, std::span<const BallDepth> depths,
                      const QualityOptions& options, MedialQuality& quality) {
  std::vector<double> radius_error;
  radius_error.reserve(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i)
    radius_error.push_back(std::abs(balls[i].radius - depths[i].nearest.distance));
  quality.radius_error = spread_of(radius_error);

  const std::size_t chosen = std::min<std::size_t>(balls.size(), options.contact_cells);
  std::vector<double> off(chosen, kUndefined);
  tbb::parallel_for(std::size_t{0}, chosen, [&](std::size_t k) {
    const std::size_t i = k * balls.size() / chosen;
    off[k] = off_centre(surface, balls[i], depths[i].nearest, options.min_contact_angle, quality.diagonal);
  });
  std::erase_if(off, [](double value) { return std::isnan(value); });
  quality.centredness = off.empty() ? Spread{.max = kUndefined, .mean = kUndefined} : spread_of(off);
}

}  // namespace orchard::detail
