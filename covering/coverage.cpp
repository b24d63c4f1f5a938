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

// Returns whether all balls from a leaf up to its root certainly contain the triangle. If so, cover_of_triangle() also
// finds such a leaf and certifies the triangle.
bool path_holds(std::span<const PathBall> balls, Index leaf, const std::array<Point, 3>& triangle) {
  for (Index i = leaf; i != kNone; i = balls[i].parent)
    if (!detail::surely_holds(balls[i], triangle)) return false;
  return true;
}

constexpr Index kFew = 256;  // triangles

// Remembers the leaf whose path contained the whole last triangle. In most meshes, triangles with similar numbers are
// near each other, so the same path often contains the next one.
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
  // The triangles are processed in slices, so that the calling thread reports progress.
  const Index slice = std::max<Index>(1024, count / 50 + 1);
  std::vector<std::optional<TriangleCover>> uncovered(slice);
  for (Index begin = 0; begin < count; begin += slice) {
    report_progress(progress, "certifying", static_cast<double>(begin) / count);
    const Index end = std::min(count, begin + slice);
    // If there are few triangles, they are large, so each is a task of its own.
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
