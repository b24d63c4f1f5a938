#include "dents_below.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace orchard::detail {
namespace {

constexpr int kMaxDescentSteps = 30;      // from a place below the surface to the bottom of its dent
constexpr double kAtBottom = 1e-3;        // of the limit: that near to a ball is at the bottom
constexpr double kDeeperThanLimit = 1.1;  // times the limit: dents that are deeper are told
constexpr double kDenser = 0.1;   // of how far dents are apart: what is looked at, so that the deepest is not missed
constexpr double kShallow = 0.9;  // of the limit: nearer to the surface is another part of it

// How much of a triangle's side the plane `depth` below the triangle across loses to that of the triangle across: what
// is farther out is nearer to that one. Nothing at a reflex edge.
double lost_at(const Surface& surface, Index triangle, std::size_t edge, double depth) {
  const Index other = surface.neighbors(triangle)[edge];
  if (other == kNone) return 0;
  const Vector along = surface.corners(triangle)[(edge + 1) % 3] - surface.corners(triangle)[edge];
  const Vector &a = surface.normal(triangle), &b = surface.normal(other);
  // tan(turn / 2) = sin / (1 + cos).
  const double sine = a.cross(b).dot(along.normalized()), cosine = a.dot(b);
  return sine > 0 ? depth * sine / std::max(1 + cosine, std::numeric_limits<double>::min()) : 0;
}

// What of a triangle is `depth` below its plane and not nearer to those next to it. False if nothing is.
bool part_below(const Surface& surface, Index triangle, double depth, std::array<Point, 3>& part) {
  const std::array<Point, 3> corners = surface.corners(triangle);
  std::array<double, 3> least{};  // barycentric coordinates
  for (std::size_t i = 0; i < 3; ++i) {
    // The edge across from corner i.
    const std::size_t edge = (i + 1) % 3;
    const double length = (corners[(edge + 1) % 3] - corners[edge]).norm();
    least[i] = lost_at(surface, triangle, edge, depth) * length / (2 * surface.area(triangle));
  }
  if (!(least[0] + least[1] + least[2] < 1)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    part[i] = (1 - least[j] - least[k]) * corners[i] + least[j] * corners[j] + least[k] * corners[k] -
              depth * surface.normal(triangle);
  }
  return true;
}

std::vector<std::array<Point, 3>> parts_below(const Surface& surface, double depth) {
  std::vector<std::array<Point, 3>> parts;
  const auto triangles = static_cast<Index>(surface.mesh().triangles.size());
  parts.reserve(triangles);
  std::array<Point, 3> part{Point::Zero(), Point::Zero(), Point::Zero()};
  for (Index t = 0; t < triangles; ++t) {
    if (part_below(surface, t, depth, part)) parts.push_back(part);
  }
  return parts;
}

}  // namespace

DentsBelow::DentsBelow(const Surface& surface, double limit, double resolution)
    : surface_(surface), limit_(limit), below_(surface, parts_below(surface, limit), kShallow * limit, resolution) {}

// From a place below the surface straight down, away from what is above it, to the bottom of the dent that it is in.
UncoveredPlace DentsBelow::bottom_below(const UncoveredPlace& place, const Point& above,
                                        const Reconstruction& reconstruction) const {
  const Vector down = (place.position - above).normalized();
  Point bottom = place.position;
  double gap = place.value;
  for (int step = 0; step < kMaxDescentSteps && gap > kAtBottom * limit_; ++step) {
    bottom += gap * down;
    gap = reconstruction.distance(bottom);
  }
  ClosestPoint nearest;
  const double depth = -surface_.signed_distance(bottom, nearest);
  return {depth, nearest.position, bottom};
}

std::vector<UncoveredPlace> DentsBelow::find(const Reconstruction& reconstruction, double apart) {
  std::vector<UncoveredPlace> dents;
  for (const UncoveredPlace& place : below_.find(reconstruction, kDenser * apart)) {
    ClosestPoint above;
    if (-surface_.signed_distance(place.position, above) < kShallow * limit_) continue;
    const UncoveredPlace dent = bottom_below(place, above.position, reconstruction);
    if (dent.value > kDeeperThanLimit * limit_) dents.push_back(dent);
  }
  return worst_apart(std::move(dents), apart, surface_.bounding_box());
}

}  // namespace orchard::detail
