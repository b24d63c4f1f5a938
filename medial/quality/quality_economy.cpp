#include <tbb/parallel_for.h>

#include <algorithm>
#include <queue>
#include <utility>

#include "quality_parts.h"

namespace orchard::detail {
namespace {

// Balls that, enlarged by the error, keep within it of the solid: those that protrude no more.
std::vector<Sphere> admissible_balls(const Surface& surface, const MedialMesh& mesh, Index max, double error) {
  const std::size_t count = mesh.centers.size(), chosen = std::min<std::size_t>(count, max);
  std::vector<std::uint8_t> good(chosen);
  const auto ball = [&](std::size_t i) {
    const std::size_t vertex = i * count / chosen;
    return Sphere{mesh.centers[vertex], mesh.radii[vertex]};
  };
  tbb::parallel_for(std::size_t{0}, chosen, [&](std::size_t i) {
    good[i] = surface.signed_distance(ball(i).center) + ball(i).radius <= error ? 1 : 0;
  });
  std::vector<Sphere> balls;
  for (std::size_t i = 0; i < chosen; ++i) {
    if (good[i]) balls.push_back(ball(i));
  }
  return balls;
}

// The samples within `error` of each ball, found in columns of samples sorted along x.
std::vector<std::vector<Index>> samples_of_balls(const std::vector<Sphere>& balls, std::vector<SurfaceSample>& samples,
                                                 double error) {
  std::sort(samples.begin(), samples.end(),
            [](const SurfaceSample& a, const SurfaceSample& b) { return a.position.x() < b.position.x(); });
  std::vector<std::vector<Index>> covered(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    const Point& center = balls[i].center;
    const double reach = balls[i].radius + error, squared = reach * reach;
    auto sample = std::lower_bound(samples.begin(), samples.end(), center.x() - reach,
                                   [](const SurfaceSample& s, double x) { return s.position.x() < x; });
    for (; sample != samples.end() && sample->position.x() <= center.x() + reach; ++sample) {
      if ((sample->position - center).squaredNorm() <= squared) {
        covered[i].push_back(static_cast<Index>(sample - samples.begin()));
      }
    }
  });
  return covered;
}

}  // namespace

// Greedy cover: again and again the ball that reaches most of what is left. What a ball still reaches only shrinks, so
// an old count is an upper bound and most counts need not be renewed.
Economy measure_economy(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options,
                        double diagonal) {
  const double error = options.economy_error * diagonal;
  std::vector<SurfaceSample> samples = quality_samples(surface, options.economy_samples, options.seed + 1);
  const std::vector<Sphere> balls = admissible_balls(surface, mesh, options.economy_candidates, error);
  const std::vector<std::vector<Index>> covered = samples_of_balls(balls, samples, error);

  std::vector<std::uint8_t> done(samples.size(), 0);
  std::priority_queue<std::pair<std::size_t, std::size_t>> queue;
  for (std::size_t i = 0; i < balls.size(); ++i) queue.emplace(covered[i].size(), balls.size() - i);
  Economy economy;
  while (!queue.empty()) {
    const auto [bound, key] = queue.top();
    queue.pop();
    if (bound == 0) break;
    const std::vector<Index>& row = covered[balls.size() - key];
    const auto left = static_cast<std::size_t>(
        std::count_if(row.begin(), row.end(), [&](Index sample) { return done[sample] == 0; }));
    if (left < bound) {
      queue.emplace(left, key);
      continue;
    }
    ++economy.spheres;
    for (const Index sample : row) done[sample] = 1;
  }
  const auto missed = std::count(done.begin(), done.end(), std::uint8_t{0});
  economy.uncovered = static_cast<double>(missed) / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
  return economy;
}

}  // namespace orchard::detail
