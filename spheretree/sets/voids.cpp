#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cover_set.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

// As a share of the largest radius: corners that are this near to a sphere may be on either side of it.
constexpr double kUnsure = 1e-9;
constexpr int kMaxGrowthRounds = 50;  // the maximum number of rounds of growth

struct Corner {
  Point at;
  std::array<Index, 3> balls;
};

std::vector<std::vector<Index>> later_neighbors(std::span<const Sphere> balls) {
  std::vector<std::vector<Index>> result(balls.size());
  for (Index a = 0; a < balls.size(); ++a)
    for (Index b = a + 1; b < balls.size(); ++b) {
      const double reach = balls[a].radius + balls[b].radius;
      if ((balls[a].center - balls[b].center).squaredNorm() <= reach * reach) result[a].push_back(b);
    }
  return result;
}

// Appends the two points that three spheres have in common, if there are any. If the centres are on one line, the
// spheres have at most a circle in common, which is an edge without corners.
void append_corners(const Sphere& a, const Sphere& b, const Sphere& c, std::vector<Point>& points) {
  const Vector ab = b.center - a.center, ac = c.center - a.center, normal = ab.cross(ac);
  const double squared = normal.squaredNorm(), scale = ab.squaredNorm() * ac.squaredNorm();
  if (!(squared > 1e-24 * scale)) return;
  const double u = (a.radius * a.radius - b.radius * b.radius + ab.squaredNorm()) / 2;
  const double v = (a.radius * a.radius - c.radius * c.radius + ac.squaredNorm()) / 2;
  const Vector in_plane = (u * ac - v * ab).cross(normal) / squared;
  const double height = a.radius * a.radius - in_plane.squaredNorm();
  if (height < -kUnsure * a.radius * a.radius) return;
  const Vector up = std::sqrt(std::max(0.0, height) / squared) * normal;
  points.push_back(a.center + in_plane + up);
  points.push_back(a.center + in_plane - up);
}

bool is_held(const Point& at, std::span<const Sphere> balls, const std::array<Index, 3>& own, double slack) {
  for (Index b = 0; b < balls.size(); ++b) {
    if (b == own[0] || b == own[1] || b == own[2]) continue;
    const double room = balls[b].radius - slack;
    if (room > 0 && (at - balls[b].center).squaredNorm() < room * room) return true;
  }
  return false;
}

// Returns the corners of the union's boundary that are in the solid.
std::vector<Corner> inner_corners(const Surface& surface, std::span<const Sphere> balls) {
  double slack = 0;
  for (const Sphere& ball : balls) slack = std::max(slack, kUnsure * ball.radius);
  const auto neighbors = later_neighbors(balls);
  std::vector<Corner> corners;
  std::vector<Point> points;
  for (Index a = 0; a < balls.size(); ++a)
    for (std::size_t i = 0; i < neighbors[a].size(); ++i)
      for (std::size_t j = i + 1; j < neighbors[a].size(); ++j) {
        const Index b = neighbors[a][i], c = neighbors[a][j];
        if (!std::binary_search(neighbors[b].begin(), neighbors[b].end(), c)) continue;
        points.clear();
        append_corners(balls[a], balls[b], balls[c], points);
        for (const Point& at : points)
          if (!is_held(at, balls, {a, b, c}, slack) && surface.signed_distance(at) <= 0)
            corners.push_back({at, {a, b, c}});
      }
  return corners;
}

}  // namespace

std::vector<std::vector<Point>> detail::voids_of(const Surface& surface, std::span<const Sphere> balls) {
  const std::vector<Corner> corners = inner_corners(surface, balls);
  std::vector<std::vector<Point>> voids;
  std::vector<bool> done(corners.size(), false);
  for (std::size_t first = 0; first < corners.size(); ++first) {
    if (done[first]) continue;
    std::vector<std::size_t> open{first};
    done[first] = true;
    std::vector<Point>& own = voids.emplace_back();
    while (!open.empty()) {
      const Corner& corner = corners[open.back()];
      open.pop_back();
      own.push_back(corner.at);
      for (std::size_t k = 0; k < corners.size(); ++k) {
        if (done[k]) continue;
        int common = 0;
        for (Index a : corner.balls) common += std::count(corners[k].balls.begin(), corners[k].balls.end(), a) > 0;
        if (common < 2) continue;  // an edge of a void lies on two spheres
        done[k] = true;
        open.push_back(k);
      }
    }
  }
  return voids;
}

// A void lies in the convex hull of its corners, and balls are convex. So a ball that contains the corners contains the
// void.
void detail::close_voids(const Surface& surface, std::vector<Sphere>& balls) {
  const double margin = tolerance::kCoverMargin * surface.bounding_radius();
  for (int round = 0; round < kMaxGrowthRounds; ++round) {
    const auto voids = voids_of(surface, balls);
    if (voids.empty()) return;
    for (const std::vector<Point>& corners : voids) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t best = 0;
      for (std::size_t b = 0; b < balls.size(); ++b) {
        double needed = 0;
        for (const Point& corner : corners) needed = std::max(needed, (corner - balls[b].center).norm());
        const double growth = needed - balls[b].radius;
        if (growth < least) least = growth, best = b;
      }
      balls[best].radius += std::max(0.0, least) + margin * std::ldexp(1.0, std::min(round, 20));
    }
  }
}

bool covers_solid(const Surface& surface, std::span<const Sphere> balls) {
  return inner_corners(surface, balls).empty();
}

}  // namespace orchard
