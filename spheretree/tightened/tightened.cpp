#include "orchard/spheretree/tightened.h"

#include <algorithm>
#include <string>
#include <utility>

#include "canonical_frame.h"
#include "level_samples.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/octree.h"
#include "tightened_in_frame.h"
#include "tightener.h"
#include "tree_looseness.h"

namespace orchard {
namespace {

constexpr double kStandardShare = 0.25;  // of the time that high effort takes

detail::Work work_for(Effort effort) {
  switch (effort) {
    case Effort::low:
      return {0.25, 4, 0, 8, {1, 1}};
    case Effort::standard:
      return {0.7, 14, 0, 48, {6, 1}};
    case Effort::high:
      return {1, 16, 4, 48, {4, 1}};
  }
  return {0.7, 14, 0, 48, {6, 1}};
}

// Returns the octree with which the finished tree is compared; without nodes if it is not.
SphereTree octree_to_compare_with(const Surface& surface, const TightenOptions& options) {
  if (!detail::goes_on_everywhere(options.refinement)) return {};
  SphereTree compared = octree(surface, {.depth = options.depth});
  measure_inaccuracy(compared, surface);
  return compared;
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
                                        const TightenOptions& options, const Progress& progress,
                                        const WeightField& weights) {
  const Samples samples = surface_samples(surface, sampling);
  if (samples.size() == 0) throw InputError("a tightened tree needs surface points");
  TightenOptions own = options;
  if (options.effort != Effort::high)
    return Tightener(surface, samples, surface.bounding_ball(), own, work_for(options.effort), weights, progress).run();
  // Later runs report their share of the rest, and the reported progress never decreases.
  double reported = 0;
  const auto share = [&](double from, double to) -> Progress {
    return [&, from, to](std::string_view stage, double fraction) {
      reported = std::max(reported, from + (to - from) * fraction);
      return !progress || progress(stage, reported);
    };
  };
  const Progress first = share(0, kStandardShare), rest = share(kStandardShare, 1);
  own.effort = Effort::standard;
  Tightener standard(surface, samples, surface.bounding_ball(), own, work_for(Effort::standard), weights, first);
  TightenBuild usual = standard.run();
  const SphereTree compared = octree_to_compare_with(surface, options);
  const std::vector<LevelLooseness> allowed = looseness_by_level(usual.tree, compared, surface);
  if (allowed.size() != usual.report.levels.size() + 1) return usual;
  own.effort = Effort::high;
  // With better lower levels, more spheres may become redundant above them. Then the levels above stay as they are in
  // the usual tree.
  for (Index same = 0; same < usual.report.levels.size();) {
    Tightener thorough(surface, samples, surface.bounding_ball(), own, work_for(Effort::high), weights, rest);
    TightenBuild best = thorough.run_beside(standard, same, allowed, compared);
    const std::vector<LevelLooseness> figures = looseness_by_level(best.tree, compared, surface);
    Index within = 0;
    while (within < figures.size() && figures[within].is_within(allowed[within])) ++within;
    if (within == allowed.size()) return best;
    same = std::max(same + 1, within);
  }
  return usual;
}

}  // namespace orchard
