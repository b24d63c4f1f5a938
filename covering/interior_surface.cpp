#include "interior_surface.h"

#include <algorithm>
#include <cmath>

// Why fill() is a proof: all triangles near the ball lie in one slab, or in two slabs that cross. Cut the slabs out of
// the ball. The rest consists of convex parts that no triangle meets, so the winding number is constant in each. If it
// is positive in all of them, every point of the ball is near a place inside the solid, because the distance out of the
// slabs is at most a few thicknesses divided by the sine of the angle between them.
namespace orchard::detail {
namespace {

// Of a slab to either side, over R: coordinates with six digits are that far off a plane.
constexpr double kThickness = 1e-6;
constexpr double kMinSine = 0.3;  // of the angle between two slabs
constexpr double kClear = 4;      // in thicknesses: how far from a plane the winding number is computed
// In thicknesses: the longest path out of two slabs and across one of them.
constexpr double kWay = 2 * (kClear + 1) / kMinSine;

// Returns how far to go along a plane's normal, from a place at signed distance `distance`, to be at least `clear` away
// from the plane on `side` (+1 or -1).
double way_to_side(double distance, int side, double clear) { return side * std::max(0.0, clear - side * distance); }

}  // namespace

InteriorSurface::InteriorSurface(const Surface& surface)
    : surface_(surface), thickness_(kThickness * surface.bounding_radius()), depth_(kWay * thickness_) {}

bool InteriorSurface::fill(const Sphere& ball) const {
  const Sphere larger{ball.center, ball.radius + 2 * depth_};
  const auto [planes, count] = planes_near(larger);
  if (count == 0) return false;
  return count == 1 ? is_inside_beyond(planes[0], larger) : is_inside_beyond(planes, larger);
}

bool InteriorSurface::in_slab(const Plane& plane, Index triangle) const {
  const auto corners = surface_.corners(triangle);
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Point& corner) { return std::abs(plane.distance(corner)) <= thickness_; });
}

InteriorSurface::Planes InteriorSurface::planes_near(const Sphere& ball) const {
  Planes found;
  bool too_many = false;
  surface_.visit_nearest(ball.center, [&](Index triangle) {
    const auto [a, b, c] = surface_.corners(triangle);
    const auto end = found.planes.begin() + static_cast<std::ptrdiff_t>(found.count);
    if (too_many || closest_point_of_triangle(ball.center, a, b, c).distance > ball.radius ||
        std::any_of(found.planes.begin(), end, [&](const Plane& plane) { return in_slab(plane, triangle); }))
      return too_many ? 0 : ball.radius;
    const Vector& normal = surface_.normal(triangle);
    const Plane plane{normal, normal.dot(a)};
    // The computed normal of a sliver may be so inaccurate that the triangle does not lie in the slab of its own plane.
    too_many = found.count == 2 || !in_slab(plane, triangle) ||
               (found.count == 1 && found.planes[0].normal.cross(normal).norm() < kMinSine);
    if (!too_many) found.planes[found.count++] = plane;
    return too_many ? 0 : ball.radius;
  });
  if (too_many) found.count = 0;
  return found;
}

// Tests a place on each side of the slab, if the ball reaches that side. Returns whether all of them are inside the
// solid.
bool InteriorSurface::is_inside_beyond(const Plane& plane, const Sphere& ball) const {
  const double distance = plane.distance(ball.center);
  for (const int side : {-1, 1}) {
    const double way = way_to_side(distance, side, kClear * thickness_);
    if (std::abs(way) < ball.radius && !is_inside(ball.center + way * plane.normal)) return false;
  }
  return true;
}

// The same for the four parts outside two slabs. In each part, the place nearest to the ball's centre is tested, which
// is reached by going along one of the normals or along both.
bool InteriorSurface::is_inside_beyond(const std::array<Plane, 2>& planes, const Sphere& ball) const {
  const double clear = kClear * thickness_;
  const double cosine = planes[0].normal.dot(planes[1].normal), squared_sine = (1 - cosine) * (1 + cosine);
  const std::array<double, 2> distance{planes[0].distance(ball.center), planes[1].distance(ball.center)};
  for (const int first : {-1, 1}) {
    for (const int second : {-1, 1}) {
      const auto is_there = [&](const Point& at) {
        return first * planes[0].distance(at) >= 0.99 * clear && second * planes[1].distance(at) >= 0.99 * clear;
      };
      const double a = first * clear - distance[0], b = second * clear - distance[1];
      const std::array<Point, 3> places{
          ball.center + way_to_side(distance[0], first, clear) * planes[0].normal,
          ball.center + way_to_side(distance[1], second, clear) * planes[1].normal,
          ball.center + ((a - cosine * b) * planes[0].normal + (b - cosine * a) * planes[1].normal) / squared_sine};
      const auto place = std::find_if(places.begin(), places.end(), is_there);
      if (place != places.end() && (*place - ball.center).norm() < ball.radius && !is_inside(*place)) return false;
    }
  }
  return true;
}

}  // namespace orchard::detail
