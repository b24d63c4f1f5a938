#include "cover_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canonical_frame.h"
#include "orchard/covering/coverage.h"
#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/build.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/outside_volume.h"
#include "sampled_distances.h"
#include "tightened/tightened_in_frame.h"
#include "weight_field.h"

namespace orchard::detail {
namespace {

// The measurement of sets that are compared: few samples, the same for all sets.
constexpr std::uint64_t kJudgingRays = 8000;
constexpr Index kJudgingSamples = 4000;

// One of several searches for a set of few spheres. The results depend on the start and the objective, and a search for
// few spheres is fast.
struct Search {
  Objective objective;
  Effort effort;
  std::uint64_t seed = 0;  // in addition to that of the options
};

constexpr Index kFewSpheres = 32;  // spheres
// Numbers of surface points; more points do not improve the sets.
constexpr Index kLowEffortSamples = 2000, kLowEffortSamplesPerBall = 100;  // with low effort
constexpr Index kSomeSamples = 2400, kSomeSamplesPerBall = 120;

// Several short searches with different objectives find better sets of few spheres than one long search, in less time.
std::vector<Search> searches_for(Index spheres, Effort effort) {
  if (effort == Effort::low || (effort == Effort::standard && spheres > kFewSpheres))
    return {{Objective::balanced, effort}};
  constexpr Objective kAll[] = {Objective::balanced, Objective::volume, Objective::mean, Objective::maximum};
  std::vector<Search> searches;
  for (const Objective objective : kAll) searches.push_back({objective, Effort::low});
  searches.push_back({Objective::volume, Effort::low, 1});
  if (effort == Effort::standard) return searches;
  for (const std::uint64_t seed : {0U, 1U})
    for (const Objective objective : kAll) searches.push_back({objective, Effort::standard, seed});
  return searches;
}

Index samples_for_cover(const SphereSetOptions& options) {
  const bool few = options.effort == Effort::low;
  const Index least = few ? kLowEffortSamples : kSomeSamples,
              per_ball = few ? kLowEffortSamplesPerBall : kSomeSamplesPerBall;
  return std::min(samples_needed(TightenOptions{.spheres = {options.spheres}}),
                  std::max(least, per_ball * options.spheres));
}

std::vector<Sphere> leaves_of(const SphereTree& tree) {
  std::vector<Sphere> leaves;
  for (const SphereNode& node : tree.nodes)
    if (node.child_count == 0) leaves.push_back(node.sphere);
  return leaves;
}

bool is_covered(const Surface& surface, const std::vector<Sphere>& balls) {
  const Point origin = surface.bounding_box().center();
  return surface_coverage(surface, path_balls(balls, origin), origin).complete();
}

// Returns the spheres of one search. They cover the surface without the root of the tree.
std::vector<Sphere> searched(const Surface& surface, const FramedSurface& framed, const SurfaceSampling& sampling,
                             const WeightField& weights, const TightenOptions& options, const Progress& progress) {
  TightenBuild build =
      tightened_in_frame(framed.surface(), sampling, options, progress, weights.in(framed.surface().bounding_box()));
  framed.take_out(build.tree);
  std::vector<Sphere> balls = leaves_of(build.tree);
  if (!is_covered(surface, balls)) {
    cover(build.tree, surface, progress);
    balls = leaves_of(build.tree);
  }
  return balls;
}

// Returns the value by which sets are compared: the square of the largest distance outside, times the mean distance,
// times the volume outside. The product prevents that one of them is reduced at a high cost of the others. The largest
// distance, which differs most between searches, has the highest weight.
double looseness(const Surface& surface, const WeightField& weights, const std::vector<Sphere>& balls) {
  double max = 0;
  for (const Sphere& ball : balls)
    max = std::max(max, weights.at(ball.center) * inaccuracy(surface, ball, {1e-3, 1e-2}).upper);
  const UnionBoundary boundary(balls, kJudgingSamples);
  double sum = 0;
  for (const UnionBoundary::Sample& sample : boundary.samples())
    sum += sample.area * weights.at(sample.at) * std::max(0.0, surface.signed_distance(sample.at));
  return max * max * sum / boundary.area() * outside_volume(surface, balls, kJudgingRays);
}

}  // namespace

std::vector<Sphere> cover_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress) {
  if (options.spheres == 1) {
    const Sphere& bounds = surface.bounding_ball();
    return {{bounds.center, bounds.radius * (1 + tolerance::kCoverMargin)}};
  }
  const FramedSurface framed(surface);
  const Index samples = samples_for_cover(options);
  SamplingOptions sampling_options{.face_points = samples - samples / 5, .edge_points = samples / 5};
  sampling_options.seed = options.seed;
  const SurfaceSampling sampling = sample_surface(framed.surface(), sampling_options, progress);
  const std::vector<Search> searches = searches_for(options.spheres, options.effort);
  const WeightField weights(surface, options.weights);
  std::vector<Sphere> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < searches.size(); ++i) {
    TightenOptions own{.depth = 1,
                       .spheres = {options.spheres},
                       .objective = searches[i].objective,
                       .seed = options.seed + searches[i].seed};
    own.effort = searches[i].effort;
    const Progress share = [&](std::string_view stage, double fraction) {
      return !progress || progress(stage, (static_cast<double>(i) + fraction) / static_cast<double>(searches.size()));
    };
    std::vector<Sphere> balls = searched(surface, framed, sampling, weights, own, share);
    const double own_looseness = searches.size() > 1 ? looseness(surface, weights, balls) : 0;
    if (!(own_looseness < least) && !best.empty()) continue;
    least = own_looseness;
    best = std::move(balls);
  }
  return best;
}

}  // namespace orchard::detail
