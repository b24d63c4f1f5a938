#include "orchard/covering/coverage.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "lemma_check.h"
#include "orchard/covering/path_forest.h"

namespace orchard {
namespace {

// Whether all balls from a leaf up to its root surely hold the triangle. Then cover_of_triangle() finds such a leaf,
// too, and says that the triangle is covered.
bool path_holds(std::span<const PathBall> balls, Index leaf, const std::array<Point, 3>& triangle) {
  for (Index i = leaf; i != kNone; i = balls[i].parent)
    if (!detail::surely_holds(balls[i], triangle)) return false;
  return true;
}

constexpr Index kFew = 256;  // triangles

// Keeps the leaf that held the last triangle whole: in most meshes triangles with numbers near each other lie near each
// other.
struct Worker {
  NearBalls near;
  Index leaf = kNone;
};

Coverage check(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls,
               const Progress& progress, const Point& origin) {
  const PathForest forest(balls);
  const Index count = static_cast<Index>(triangles.size());
  Coverage coverage;
  tbb::enumerable_thread_specific<Worker> workers;
  // In slices, so that progress is reported from the calling thread.
  const Index slice = std::max<Index>(1024, count / 50 + 1);
  std::vector<std::optional<TriangleCover>> uncovered(slice);
  for (Index begin = 0; begin < count; begin += slice) {
    report_progress(progress, "certifying", static_cast<double>(begin) / count);
    const Index end = std::min(count, begin + slice);
    // One at a time where there are few, which are large.
    tbb::parallel_for(tbb::blocked_range<Index>(begin, end, count < kFew ? 1 : 16), [&](const auto& range) {
      auto& [near, leaf] = workers.local();
      for (Index i = range.begin(); i != range.end(); ++i) {
        auto corners = surface.corners(triangles[i]);
        for (Point& corner : corners) corner -= origin;
        if (leaf != kNone && path_holds(balls, leaf, corners)) continue;
        forest.gather(corners, near);
        TriangleCover cover = cover_of_triangle(corners, near.balls);
        if (cover.covered) {
          if (!cover.coverers.empty()) leaf = near.original[cover.coverers.front()];
          continue;
        }
        for (UncoveredArc& arc : cover.arcs) arc.ball = near.original[arc.ball];
        uncovered[i - begin] = std::move(cover);
      }
    });
    for (Index i = begin; i < end; ++i) {
      if (uncovered[i - begin]) coverage.uncovered.push_back({triangles[i], std::move(*uncovered[i - begin])});
      uncovered[i - begin].reset();
    }
  }
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
