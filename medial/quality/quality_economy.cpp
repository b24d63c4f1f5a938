#include <tbb/parallel_for.h>

#include <algorithm>
#include <queue>
#include <utility>

#include "quality_parts.h"

namespace orchard::detail {
namespace {

constexpr std::size_t kCluster = 64;  // samples that are tested together

// Returns the admissible balls, those that protrude from the solid by at most `error`.
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

// Samples that lie close to each other.
struct Cluster {
  std::size_t begin, end;
  Box box;
};

// Divides samples into clusters by halving them along the longest side of their box.
void add_clusters(std::vector<SurfaceSample>& samples, std::size_t begin, std::size_t end,
                  std::vector<Cluster>& clusters) {
  Box box;
  for (std::size_t i = begin; i < end; ++i) box.extend(samples[i].position);
  if (end - begin <= kCluster) {
    clusters.push_back({begin, end, box});
    return;
  }
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return samples.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const SurfaceSample& a, const SurfaceSample& b) {
    return a.position[axis] < b.position[axis];
  });
  add_clusters(samples, begin, middle, clusters);
  add_clusters(samples, middle, end, clusters);
}

// Returns the samples within `error` of each ball. Reorders the samples such that near ones are adjacent.
std::vector<std::vector<Index>> samples_of_balls(const std::vector<Sphere>& balls, std::vector<SurfaceSample>& samples,
                                                 double error) {
  std::vector<Cluster> clusters;
  add_clusters(samples, 0, samples.size(), clusters);
  std::vector<std::vector<Index>> covered(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    const Point& center = balls[i].center;
    const double reach = balls[i].radius + error, squared = reach * reach;
    for (const Cluster& cluster : clusters) {
      if (cluster.box.squaredExteriorDistance(center) > squared) continue;
      for (std::size_t k = cluster.begin; k < cluster.end; ++k) {
        if ((samples[k].position - center).squaredNorm() <= squared) covered[i].push_back(static_cast<Index>(k));
      }
    }
  });
  return covered;
}

}  // namespace

// Computes the greedy cover: the next ball is always the one that reaches most of the remaining samples. The number
// that a ball reaches can only fall, so an old count is an upper bound, and most counts need no update.
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
