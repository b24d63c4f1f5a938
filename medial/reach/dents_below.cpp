#include "dents_below.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace orchard::detail {
namespace {

constexpr int kMaxDescentSteps = 30;  // the number of steps from a place below the surface to the bottom of its dent
constexpr double kAtBottom = 1e-3;    // of the limit: a place this near to a ball counts as the bottom
constexpr double kDeeperThanLimit = 1.1;  // times the limit: only deeper dents are reported
// Of the minimum distance of two dents: how densely places are examined, so that the deepest one is not missed.
constexpr double kDenser = 0.1;
// Of the limit: a place nearer to the surface than this belongs to another part of the surface.
constexpr double kShallow = 0.9;

// Returns how much of a triangle's side, at `depth` below it, belongs to the triangle across that side, because places
// farther out are nearer to that one. At a reflex edge this is 0.
double lost_at(const Surface& surface, Index triangle, std::size_t edge, double depth) {
  const Index other = surface.neighbors(triangle)[edge];
  if (other == kNone) return 0;
  const Vector along = surface.corners(triangle)[(edge + 1) % 3] - surface.corners(triangle)[edge];
  const Vector &a = surface.normal(triangle), &b = surface.normal(other);
  // By the half-angle formula, tan(turn / 2) = sin / (1 + cos).
  const double sine = a.cross(b).dot(along.normalized()), cosine = a.dot(b);
  return sine > 0 ? depth * sine / std::max(1 + cosine, std::numeric_limits<double>::min()) : 0;
}

// Finds the part of a triangle, moved down by `depth`, that is not nearer to the adjacent triangles. Returns false if
// there is none.
bool part_below(const Surface& surface, Index triangle, double depth, std::array<Point, 3>& part) {
  const std::array<Point, 3> corners = surface.corners(triangle);
  std::array<double, 3> least{};  // lower bounds on the barycentric coordinates of the part
  for (std::size_t i = 0; i < 3; ++i) {
    // the edge opposite to corner i
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

// Moves from a place below the surface straight down, away from `above`, to the bottom of the dent that contains it.
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
