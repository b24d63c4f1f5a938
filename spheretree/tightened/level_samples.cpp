#include "level_samples.h"

#include <algorithm>

namespace orchard::detail {
namespace {

// Large balls need few samples for each to be judged by.
constexpr Index kEnoughSamplesPerBall = 64, kFewestSamples = 4000;
// Radii that differ by less, as a fraction of R, are the same.
constexpr double kAsLarge = 1e-6;

// The largest of the balls that touch each surface point; of balls that are as large but for rounding, as where many
// points lie on one sphere, the first by its place, whatever their order.
std::vector<Index> poles(const MedialAxis& axis, const CanonicalFrame& frame, double bounding_radius) {
  const auto before = [&](Index a, Index b) {
    const Point p = frame.roughly_in(axis.centers[a]), q = frame.roughly_in(axis.centers[b]);
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<Index> pole(axis.points.size(), kNone);
  for (Index v = 0; v < axis.size(); ++v)
    for (Index p : axis.forming_points[v]) {
      const double larger = pole[p] == kNone ? bounding_radius : axis.radii[v] - axis.radii[pole[p]];
      if (larger > kAsLarge * bounding_radius || (larger > -kAsLarge * bounding_radius && before(v, pole[p])))
        pole[p] = v;
    }
  return pole;
}

}  // namespace

Samples surface_samples(const Surface& surface, const MedialAxis& axis, const CanonicalFrame& frame) {
  const std::vector<Index> pole = poles(axis, frame, surface.bounding_radius());
  Samples samples;
  for (Index p = 0; p < axis.points.size(); ++p) {
    samples.points.push_back(frame.in(axis.points[p]));
    samples.starts.push_back(frame.roughly_in(pole[p] == kNone ? axis.points[p] : axis.centers[pole[p]]));
  }
  if (surface.mesh().vertices.size() > axis.points.size()) return samples;
  for (Index v = 0; v < surface.mesh().vertices.size(); ++v) {
    if (surface.triangles_around(v).empty()) continue;
    samples.points.push_back(frame.in(surface.mesh().vertices[v]));
    samples.starts.push_back(samples.points.back());
  }
  return samples;
}

Index enough_samples(Index balls) { return std::max<Index>(kFewestSamples, kEnoughSamplesPerBall * balls); }

Samples samples_for(const Samples& all, const PartialTree& partial, Index enough) {
  const Index stride = std::max<Index>(1, all.size() / enough);
  Samples chosen;
  for (Index s = 0; s < all.size(); s += stride) {
    if (partial.in_leaf(all.points[s])) continue;
    chosen.points.push_back(all.points[s]);
    chosen.starts.push_back(all.starts[s]);
  }
  return chosen;
}

}  // namespace orchard::detail
