#include "level_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "canonical_frame.h"
#include "path_regions.h"

namespace orchard::detail {
namespace {

// A few samples for each ball are enough to judge it by.
constexpr Index kEnoughSamplesPerBall = 64, kFewestSamples = 2000;
constexpr int kShrinks = 12;             // of the ball that touches the surface in a sample
constexpr double kEmpty = 1 - 1e-3;      // a ball whose centre is as far from the surface, in radii, touches it
constexpr double kSmallestStart = 0.01;  // radius of such a ball, in R

std::vector<Index> without_repair(const SurfaceSampling& sampling) {
  std::vector<Index> sampled;
  for (Index p = 0; p < sampling.size(); ++p)
    if (sampling.origins[p] != PointOrigin::repair) sampled.push_back(p);
  return sampled;
}

}  // namespace

Point touching_center(const Surface& surface, const Point& point, const Vector& outward) {
  double radius = surface.bounding_radius();
  const double min = kSmallestStart * radius;
  for (int k = 0; k < kShrinks; ++k) {
    const Point center = point - radius * outward;
    const ClosestPoint nearest = surface.closest_within(center, kEmpty * radius);
    if (nearest.triangle == kNone) break;
    const Vector across = point - nearest.position;
    const double along = outward.dot(across);
    if (!(along > 0)) break;
    const double smaller = across.squaredNorm() / (2 * along);
    if (!(smaller < radius)) break;
    radius = std::max(smaller, min);
    if (radius == min) break;
  }
  return point - radius * outward;
}

Samples surface_samples(const Surface& surface, const SurfaceSampling& sampling) {
  const std::vector<Index> sampled = without_repair(sampling);
  const auto count = static_cast<Index>(sampled.size());
  Samples samples;
  samples.points.resize(count);
  samples.starts.resize(count);
  tbb::parallel_for(Index{0}, count, [&](Index p) {
    const Index from = sampled[p];
    // Points on edges are only spaced evenly, so all their digits are reliable. Relaxation makes the last digits of
    // other points arbitrary: these are rounded first.
    const bool exact = sampling.origins[from] == PointOrigin::edge;
    const Point& point = sampling.points[from];
    samples.points[p] = on_fine_lattice(exact ? point : surface.closest(on_coarse_lattice(point)).position);
    const ClosestPoint on = surface.closest(samples.points[p]);
    samples.starts[p] = touching_center(surface, samples.points[p], surface.pseudonormal(on.triangle, on.feature));
  });
  if (surface.mesh().vertices.size() > sampled.size()) return samples;
  for (Index v = 0; v < surface.mesh().vertices.size(); ++v) {
    if (surface.triangles_around(v).empty()) continue;
    samples.points.push_back(surface.mesh().vertices[v]);
    samples.starts.push_back(samples.points.back());
  }
  return samples;
}

Index enough_samples(Index balls) { return std::max<Index>(kFewestSamples, kEnoughSamplesPerBall * balls); }

Samples samples_for(const Samples& all, const PartialTree& partial, Index enough) {
  const Index stride = std::max<Index>(1, all.size() / enough);
  const PathRegions leaves({}, partial.leaf_paths());
  Samples chosen;
  for (Index s = 0; s < all.size(); s += stride) {
    if (!leaves.regions_around(all.points[s]).empty()) continue;
    chosen.points.push_back(all.points[s]);
    chosen.starts.push_back(all.starts[s]);
  }
  return chosen;
}

}  // namespace orchard::detail
