#include "orchard/spheretree/descent.h"

#include <algorithm>

#include "orchard/covering/incremental_cover.h"
#include "orchard/geometry/random.h"
#include "random_direction.h"

namespace orchard {
namespace {

constexpr std::uint64_t kDescentStage = 300;  // the stream of random numbers
// Sizes of steps over the looseness of the ball: the first one, and the one below which a ball is finished; then the
// factors by which a step is changed.
constexpr double kFirstDescentStep = 0.2, kMinDescentStep = 2e-4;
constexpr double kLongerDescent = 1.6, kShorterDescent = 0.85;

class Descent {
 public:
  Descent(SphereTree& tree, const Surface& surface, const DescentOptions& options)
      : tree_(tree), surface_(surface), options_(options), cover_(surface, path_balls(tree)) {
    const std::size_t count = tree.nodes.size();
    center_distance_.resize(count);
    step_.assign(count, kFirstDescentStep);
    for (std::size_t i = 0; i < count; ++i) center_distance_[i] = surface.signed_distance(tree.nodes[i].sphere.center);
  }

  DescentReport run(const Progress& progress) {
    DescentReport report;
    report.looseness_before = mean_looseness();
    for (Index round = 0; round < options_.trials_per_node; ++round) {
      report_progress(progress, "random descent", static_cast<double>(round) / options_.trials_per_node);
      for (Index node = 0; node < tree_.nodes.size(); ++node) {
        if (step_[node] < kMinDescentStep) continue;
        ++report.trials;
        Random random(options_.seed, kDescentStage + round, node);
        const bool better = try_node(node, random);
        report.accepted += better;
        step_[node] = std::min(kFirstDescentStep, step_[node] * (better ? kLongerDescent : kShorterDescent));
      }
    }
    report.looseness_after = mean_looseness();
    return report;
  }

 private:
  double mean_looseness() const {
    double sum = 0;
    for (std::size_t i = 0; i < center_distance_.size(); ++i) sum += tree_.nodes[i].sphere.radius + center_distance_[i];
    return sum / static_cast<double>(center_distance_.size()) / surface_.bounding_radius();
  }

  bool try_node(Index node, Random& random) {
    Sphere& ball = tree_.nodes[node].sphere;
    const double looseness = ball.radius + center_distance_[node], size = step_[node] * looseness;
    if (!(looseness > 0)) return false;
    Sphere next = ball;
    next.center += random.uniform() * size * random_direction(random);
    const double center_distance = surface_.signed_distance(next.center);
    // The new ball is less loose by a random part of the step, whatever the move of its centre does to the distance.
    next.radius = looseness - 0.5 * random.uniform() * size - center_distance;
    if (!(next.radius > 0) || !cover_.try_change(node, next)) return false;
    ball = next;
    center_distance_[node] = center_distance;
    return true;
  }

  SphereTree& tree_;
  const Surface& surface_;
  const DescentOptions& options_;
  IncrementalCover cover_;
  std::vector<double> center_distance_, step_;
};

}  // namespace

DescentReport random_descent(SphereTree& tree, const Surface& surface, const DescentOptions& options,
                             const Progress& progress) {
  return Descent(tree, surface, options).run(progress);
}

}  // namespace orchard
