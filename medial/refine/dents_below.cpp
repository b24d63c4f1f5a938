#include "dents_below.h"

#include <algorithm>
#include <array>

namespace orchard::detail {
namespace {

constexpr int kMaxSteps = 30;      // from a place below the surface to the bottom of its dent
constexpr double kArrived = 1e-3;  // of the limit: that near to a ball is at the bottom
constexpr double kDeep = 1.1;      // times the limit: dents that are deeper are told
constexpr double kDenser = 0.1;    // of how far dents are apart: what is looked at, so that the deepest is not missed
constexpr double kShallow = 0.9;   // of the limit: nearer to the surface is another part of it

std::vector<std::array<Point, 3>> parts_below(const Surface& surface, double depth) {
  std::vector<std::array<Point, 3>> parts;
  const auto triangles = static_cast<Index>(surface.mesh().triangles.size());
  parts.reserve(triangles);
  for (Index t = 0; t < triangles; ++t) {
    parts.push_back(surface.corners(t));
    for (Point& corner : parts.back()) corner -= depth * surface.normal(t);
  }
  return parts;
}

}  // namespace

DentsBelow::DentsBelow(const Surface& surface, double limit, double resolution)
    : surface_(surface), limit_(limit), below_(surface, parts_below(surface, limit), kShallow * limit, resolution) {}

// From a place below the surface straight down to the bottom of the dent that it is in.
UncoveredPlace DentsBelow::bottom_below(const UncoveredPlace& place, const Reconstruction& reconstruction) const {
  const Vector down = (place.position - surface_.closest(place.position).position).normalized();
  Point bottom = place.position;
  double gap = place.value;
  for (int step = 0; step < kMaxSteps && gap > kArrived * limit_; ++step) {
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
    if (-surface_.signed_distance(place.position) < kShallow * limit_) continue;
    const UncoveredPlace dent = bottom_below(place, reconstruction);
    if (dent.value > kDeep * limit_) dents.push_back(dent);
  }
  std::stable_sort(dents.begin(), dents.end(),
                   [](const UncoveredPlace& a, const UncoveredPlace& b) { return a.value > b.value; });
  std::vector<UncoveredPlace> far_apart;
  for (const UncoveredPlace& dent : dents) {
    const auto is_near = [&](const UncoveredPlace& other) { return (other.inside - dent.inside).norm() < apart; };
    if (std::none_of(far_apart.begin(), far_apart.end(), is_near)) far_apart.push_back(dent);
  }
  return far_apart;
}

}  // namespace orchard::detail
