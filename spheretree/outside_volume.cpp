#include "orchard/spheretree/outside_volume.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <span>
#include <vector>

#include "orchard/geometry/error.h"
#include "parallel_rays.h"

namespace orchard {
namespace {

using detail::ByRay, detail::Crossing, detail::Interval, detail::ParallelRays;

double length_inside(std::span<const Crossing> crossings, double begin, double end) {
  double length = 0;
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].rise;
    if (winding > 0) length += std::max(0.0, std::min(end, crossings[i + 1].at) - std::max(begin, crossings[i].at));
  }
  return length;
}

// Returns the length of the part of the chords' union that is outside.
double length_outside(std::span<const Interval> chords, std::span<const Crossing> crossings) {
  double length = 0;
  for (std::size_t i = 0; i < chords.size();) {
    Interval joined = chords[i++];
    for (; i < chords.size() && chords[i].begin <= joined.end; ++i) joined.end = std::max(joined.end, chords[i].end);
    length += joined.end - joined.begin - length_inside(crossings, joined.begin, joined.end);
  }
  return length;
}

}  // namespace

double outside_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t count) {
  if (!surface.solid()) throw InputError("the outside volume needs a closed surface; repair the mesh first");
  if (balls.empty() || count == 0) return 0;
  Box box;
  for (const Sphere& ball : balls) {
    box.extend(Point(ball.center - Vector::Constant(ball.radius)));
    box.extend(Point(ball.center + Vector::Constant(ball.radius)));
  }
  const ParallelRays rays(box, count);
  ByRay<Crossing> through_surface(rays.size());
  ByRay<Interval> through_balls(rays.size());
  tbb::parallel_invoke([&] { find_crossings(surface, rays, through_surface); },
                       [&] { find_chords(balls, rays, through_balls); });
  double sum = 0;
  for (std::size_t ray = 0; ray < rays.size(); ++ray) sum += length_outside(through_balls[ray], through_surface[ray]);
  return rays.area() * sum / static_cast<double>(rays.size());
}

}  // namespace orchard
