#include "orchard/covering/coverage.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "orchard/covering/path_forest.h"

namespace orchard {
namespace {

Coverage check(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls,
               const Progress& progress, const Point& origin) {
  const PathForest forest(balls);
  const Index count = static_cast<Index>(triangles.size());
  std::vector<TriangleCover> covers(count);
  tbb::enumerable_thread_specific<NearBalls> scratch;
  // In slices, so that progress is reported from the calling thread.
  const Index slice = std::max<Index>(1024, count / 50 + 1);
  for (Index begin = 0; begin < count; begin += slice) {
    report_progress(progress, "certifying", static_cast<double>(begin) / count);
    tbb::parallel_for(tbb::blocked_range<Index>(begin, std::min(count, begin + slice), 16), [&](const auto& range) {
      NearBalls& near = scratch.local();
      for (Index i = range.begin(); i != range.end(); ++i) {
        auto corners = surface.corners(triangles[i]);
        for (Point& corner : corners) corner -= origin;
        forest.gather(corners, near);
        covers[i] = cover_of_triangle(corners, near.balls);
        for (UncoveredArc& arc : covers[i].arcs) arc.ball = near.original[arc.ball];
      }
    });
  }
  Coverage coverage;
  for (Index i = 0; i < count; ++i)
    if (!covers[i].covered) coverage.uncovered.push_back({triangles[i], std::move(covers[i])});
  return coverage;
}

}  // namespace

Coverage surface_coverage(const Surface& surface, std::span<const PathBall> balls, const Point& origin,
                          const Progress& progress) {
  std::vector<Index> all(surface.mesh().triangles.size());
  std::iota(all.begin(), all.end(), Index{0});
  return check(surface, all, balls, progress, origin);
}

Coverage surface_coverage(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls) {
  return check(surface, triangles, balls, {}, Point::Zero());
}

}  // namespace orchard
