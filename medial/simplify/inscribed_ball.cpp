#include <algorithm>
#include <cmath>
#include <vector>

#include "orchard/geometry/error.h"
#include "orchard/medial/simplify.h"

namespace orchard {
namespace {

constexpr Index kStarts = 8;
constexpr double kTouchingSurface =
    1e-7;                          // of the radius: places this much farther than the nearest one also stop the ball
constexpr double kMinStep = 1e-9;  // of the radius
constexpr int kMaxClimbSteps = 400;
constexpr int kHullSteps = 200;

// The direction in which a centre moves away from all places of the surface within `reach` at once: the shortest vector
// of the convex hull of the directions away from them (Gilbert's method). It is almost 0 if there is no such direction.
Vector uphill(const Surface& surface, const Point& center, double reach, std::vector<Index>& near) {
  surface.triangles_near({center, reach}, near);
  std::vector<Vector> away;
  for (const Index t : near) {
    const auto [a, b, c] = surface.corners(t);
    const ClosestPoint place = closest_point_of_triangle(center, a, b, c);
    if (place.distance > 0) away.push_back((center - place.position) / place.distance);
  }
  if (away.empty()) return Vector::Zero();
  Vector min_norm = away[0];
  for (int step = 0; step < kHullSteps; ++step) {
    const Vector& extreme = *std::min_element(
        away.begin(), away.end(), [&](const Vector& x, const Vector& y) { return min_norm.dot(x) < min_norm.dot(y); });
    const Vector along = extreme - min_norm;
    if (!(-min_norm.dot(along) > 1e-12 * min_norm.squaredNorm()) || !(along.squaredNorm() > 0)) break;
    min_norm += std::clamp(-min_norm.dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
  }
  return min_norm;
}

Sphere climb(const Surface& surface, Sphere ball) {
  std::vector<Index> near;
  double length = 0.1 * ball.radius;
  for (int i = 0; i < kMaxClimbSteps && length > kMinStep * ball.radius; ++i) {
    const Vector way = uphill(surface, ball.center, ball.radius * (1 + kTouchingSurface) + 0.5 * length, near);
    if (!(way.norm() > 1e-9)) {
      length /= 4;
      continue;
    }
    const Point next = ball.center + length * way.normalized();
    const double radius = -surface.signed_distance(next);
    if (radius > ball.radius) {
      ball = {next, radius};
      length *= 1.5;
    } else {
      length /= 2;
    }
  }
  return ball;
}

}  // namespace

Sphere max_inscribed_ball(const Surface& surface, const MedialMesh& mesh) {
  if (!surface.solid())
    throw InputError("the largest ball needs a solid: " + surface.report().faults() + "; repair the mesh first");
  std::vector<Sphere> starts;
  for (const Point& center : mesh.centers) starts.push_back({center, std::max(0.0, -surface.signed_distance(center))});
  std::stable_sort(starts.begin(), starts.end(), [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  if (starts.size() > kStarts) starts.resize(kStarts);
  Sphere best;
  for (const Sphere& start : starts) {
    const Sphere ball = climb(surface, start);
    if (ball.radius > best.radius) best = ball;
  }
  return best;
}

}  // namespace orchard
