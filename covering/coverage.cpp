#include "orchard/covering/coverage.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>

namespace orchard {
namespace {

// The balls' tree, turned round so that it can be descended.
struct Descent {
  std::span<const PathBall> balls;
  std::vector<Index> roots;
  Rows children;

  explicit Descent(std::span<const PathBall> all) : balls(all) {
    std::vector<Index> count(all.size() + 1, 0);
    for (Index i = 0; i < all.size(); ++i) {
      if (all[i].parent == kNone) {
        roots.push_back(i);
      } else {
        ++count[all[i].parent + 1];
      }
    }
    std::partial_sum(count.begin(), count.end(), count.begin());
    children.offsets = count;
    children.items.resize(count.back());
    for (Index i = 0; i < all.size(); ++i)
      if (all[i].parent != kNone) children.items[count[all[i].parent]++] = i;
  }
};

// Scratch of one thread: the balls near one triangle, renumbered.
struct Near {
  std::vector<PathBall> balls;
  std::vector<Index> original;
};

// Gathers the balls whose whole path comes near the triangle. A ball that is left out does not touch the triangle, and
// neither do the path regions below it.
void gather(const Descent& descent, const std::array<Point, 3>& triangle, Near& near) {
  near.balls.clear();
  near.original.clear();
  const Point centroid = (triangle[0] + triangle[1] + triangle[2]) / 3;
  double reach = 0;
  for (const Point& corner : triangle) reach = std::max(reach, (corner - centroid).norm());
  const auto visit = [&](Index ball, Index parent) {
    const PathBall& candidate = descent.balls[ball];
    const double limit = (candidate.radius + reach) * (1 + 1e-9);
    if ((candidate.center - centroid).squaredNorm() > limit * limit) return;
    near.balls.push_back({candidate.center, candidate.radius, parent, candidate.leaf});
    near.original.push_back(ball);
  };
  for (Index root : descent.roots) visit(root, kNone);
  for (Index i = 0; i < near.balls.size(); ++i)
    for (Index child : descent.children[near.original[i]]) visit(child, i);
}

Coverage check(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls,
               const Progress& progress, const Point& origin) {
  const Descent descent(balls);
  const Index count = static_cast<Index>(triangles.size());
  std::vector<TriangleCover> covers(count);
  tbb::enumerable_thread_specific<Near> scratch;
  // In slices, so that progress is reported from the calling thread.
  const Index slice = std::max<Index>(1024, count / 50 + 1);
  for (Index begin = 0; begin < count; begin += slice) {
    report_progress(progress, "certifying", static_cast<double>(begin) / count);
    tbb::parallel_for(tbb::blocked_range<Index>(begin, std::min(count, begin + slice), 16), [&](const auto& range) {
      Near& near = scratch.local();
      for (Index i = range.begin(); i != range.end(); ++i) {
        auto corners = surface.corners(triangles[i]);
        for (Point& corner : corners) corner -= origin;
        gather(descent, corners, near);
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

Coverage surface_coverage(const Surface& surface, std::span<const PathBall> balls, const Progress& progress,
                          const Point& origin) {
  std::vector<Index> all(surface.mesh().triangles.size());
  std::iota(all.begin(), all.end(), Index{0});
  return check(surface, all, balls, progress, origin);
}

Coverage surface_coverage(const Surface& surface, std::span<const Index> triangles, std::span<const PathBall> balls) {
  return check(surface, triangles, balls, {}, Point::Zero());
}

}  // namespace orchard
