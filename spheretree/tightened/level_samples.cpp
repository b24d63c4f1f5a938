#include "level_samples.h"

#include <algorithm>

namespace orchard::detail {
namespace {

// Large balls need few samples for each to be judged by.
constexpr Index kEnoughSamplesPerBall = 500;

}  // namespace

Samples surface_samples(const Surface& surface, const MedialAxis& axis) {
  std::vector<Index> pole(axis.points.size(), kNone);
  for (Index v = 0; v < axis.size(); ++v)
    for (Index p : axis.forming_points[v])
      if (pole[p] == kNone || axis.radii[v] > axis.radii[pole[p]]) pole[p] = v;
  Samples samples;
  for (Index p = 0; p < axis.points.size(); ++p) {
    samples.points.push_back(axis.points[p]);
    samples.starts.push_back(pole[p] == kNone ? axis.points[p] : axis.centers[pole[p]]);
  }
  if (surface.mesh().vertices.size() > axis.points.size()) return samples;
  for (Index v = 0; v < surface.mesh().vertices.size(); ++v) {
    if (surface.triangles_around(v).empty()) continue;
    samples.points.push_back(surface.mesh().vertices[v]);
    samples.starts.push_back(surface.mesh().vertices[v]);
  }
  return samples;
}

Samples samples_for(const Samples& all, const PartialTree& partial, Index balls) {
  const Index enough = std::max<Index>(2000, kEnoughSamplesPerBall * balls);
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
