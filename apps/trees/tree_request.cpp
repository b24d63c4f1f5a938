#include "trees/tree_request.h"

namespace orchard::apps {
namespace {

AnnealingOptions annealing_of(const TreeRequest& request, std::uint64_t seed, double first_acceptance) {
  AnnealingOptions options = annealing_options(request.effort);
  options.depth = levels_of(request);
  options.branching = request.branching;
  options.energy = request.energy;
  options.distance = request.distance;
  options.first_acceptance = first_acceptance;
  if (request.redundancy == Selection::independent) options.redundancy = Selection::independent;
  options.refinement = request.refinement;
  options.seed = seed;
  for (const auto& set : request.schedule) set(options);
  return options;
}

}  // namespace

Index levels_of(const TreeRequest& request) {
  return request.spheres.empty() ? request.depth : static_cast<Index>(request.spheres.size());
}

TreeOptions builder_of(const TreeRequest& request, std::uint64_t seed) {
  const Index depth = levels_of(request);
  switch (request.method) {
    case TreeMethod::tightened:
      return TightenOptions{.depth = depth,
                            .branching = request.branching,
                            .spheres = request.spheres,
                            .effort = request.effort,
                            .objective = request.objective,
                            .refinement = request.refinement,
                            .seed = seed};
    case TreeMethod::merging:
      return MergeOptions{
          .depth = depth, .branching = request.branching, .refinement = request.refinement, .closing = request.closing};
    case TreeMethod::annealing:
      return annealing_of(request, seed, AnnealingOptions{}.first_acceptance);
    case TreeMethod::octree:
      return OctreeOptions{.depth = depth, .refinement = request.refinement, .branching = request.branching};
  }
  return {};
}

SphereTreeOptions tree_options(const TreeRequest& request, std::uint64_t seed) {
  SphereTreeOptions options{.tree = builder_of(request, seed), .redundancy = request.redundancy};
  if (request.anneal) options.anneal = annealing_of(request, seed, kCoolStart);
  if (request.descent_trials > 0) options.descent = {.trials_per_node = request.descent_trials, .seed = seed};
  return options;
}

}  // namespace orchard::apps
