#include "orchard/spheretree/tightened.h"

#include <array>
#include <string>
#include <utility>

#include "canonical_frame.h"
#include "level_samples.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/outside_volume.h"
#include "orchard/spheretree/redundancy.h"
#include "tightened_in_frame.h"
#include "tightener.h"

namespace orchard {
namespace {

detail::Work work_for(Effort effort) {
  switch (effort) {
    case Effort::low:
      return {0.25, 4, 0, 8, {1, 1}};
    case Effort::standard:
      return {0.7, 14, 0, 48, {6, 1}};
    case Effort::high:
      return {3, 24, 12, 96, {12, 2}};
  }
  return {0.7, 14, 0, 48, {6, 1}};
}

// What a tree is compared by, for each level: mean and largest inaccuracy, and the volume outside.
std::vector<std::array<double, 3>> figures(SphereTree tree, const Surface& surface) {
  remove_redundant(tree, surface);
  measure_inaccuracy(tree, surface);
  std::vector<std::array<double, 3>> figures;
  Index level = 0;
  for (const LevelFigures& of_level : level_figures(tree, 1)) {
    std::vector<Sphere> spheres;  // with those of leaves above
    for (const SphereNode& node : tree.nodes)
      if (node.level == level || (node.level < level && node.child_count == 0)) spheres.push_back(node.sphere);
    figures.push_back({of_level.mean_inaccuracy, of_level.max_inaccuracy, outside_volume(surface, spheres)});
    ++level;
  }
  return figures;
}

bool is_looser(const std::vector<std::array<double, 3>>& one, const std::vector<std::array<double, 3>>& other) {
  if (one.size() != other.size()) return one.size() < other.size();
  for (std::size_t level = 0; level < one.size(); ++level)
    for (std::size_t i = 0; i < 3; ++i)
      if (one[level][i] > other[level][i]) return true;
  return false;
}

}  // namespace

void require_sizes(const TightenOptions& options) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw InputError(what);
  };
  const std::string max = std::to_string(kMaxBranching);
  require(options.branching >= 2 && options.branching <= kMaxBranching, "branching must lie between 2 and " + max);
  const std::vector<Index>& spheres = options.spheres;
  if (spheres.empty()) return;
  require(spheres.size() == options.depth, "spheres: there must be one number for each level");
  require(spheres[0] >= 2 && spheres[0] <= kMaxBranching, "spheres: the first level's must lie between 2 and " + max);
  for (std::size_t i = 1; i < spheres.size(); ++i)
    require(spheres[i] > spheres[i - 1] && spheres[i] <= std::uint64_t{kMaxFanOut} * spheres[i - 1],
            "spheres: each level must have more than the one above, and at most " + std::to_string(kMaxFanOut) +
                " times as many");
}

TightenBuild tightened_tree(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options,
                            const Progress& progress) {
  require_sizes(options);
  validate(sampling, surface);
  const detail::FramedSurface framed(surface);
  TightenOptions own = options;
  own.refinement = framed.in(options.refinement);
  TightenBuild build = detail::tightened_in_frame(framed.surface(), framed.in(sampling), own, progress);
  framed.take_out(build.tree);
  return build;
}

TightenBuild detail::tightened_in_frame(const Surface& surface, const SurfaceSampling& sampling,
                                        const TightenOptions& options, const Progress& progress) {
  const Samples samples = surface_samples(surface, sampling);
  if (samples.size() == 0) throw InputError("a tightened tree needs surface points");
  TightenOptions own = options;
  if (options.effort != Effort::high)
    return Tightener(surface, samples, surface.bounding_ball(), own, work_for(options.effort), progress).run();
  own.effort = Effort::standard;
  Tightener standard(surface, samples, surface.bounding_ball(), own, work_for(Effort::standard), progress);
  TightenBuild usual = standard.run();
  own.effort = Effort::high;
  TightenBuild best =
      Tightener(surface, samples, surface.bounding_ball(), own, work_for(Effort::high), progress).run_beside(standard);
  return is_looser(figures(best.tree, surface), figures(usual.tree, surface)) ? usual : best;
}

}  // namespace orchard
