#include "orchard/spheretree/build.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "canonical_frame.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/proven.h"
#include "tightened/tightened_in_frame.h"
#include "tightened/tree_looseness.h"

namespace orchard {
namespace {

constexpr double kSamplesPerLeaf = 20;
constexpr double kGrowthFactor = 1.1;  // of dissertation 6.3.2
constexpr double kCoolStart = 0.05;    // first acceptance where annealing is not to forget what it starts from

TightenOptions tightening_options(const SphereTreeOptions& o) {
  return {o.depth, o.branching, o.spheres, o.effort, o.objective, o.refinement, o.seed};
}

// Trees are built in the surface's frame, so that they do not depend on where it lies and how large it is: all but
// merged ones, which begin with the given surface's medial axis.
class TreeBuilder {
 public:
  TreeBuilder(const Surface& surface, const SphereTreeOptions& options, const Progress& progress)
      : given_(surface),
        framed_(surface),
        surface_(in_frame(options) ? framed_.surface() : surface),
        options_(options),
        progress_(progress) {
    if (in_frame(options)) options_.refinement = framed_.in(options.refinement);
    build_.method = options.method;
    build_.effort = options.effort;
    build_.seed = options.seed;
  }

  SphereTreeBuild run(MedialBuildInput input) {
    stage("octree to compare with",
          [&] { build_.octree = octree(framed_.surface(), {.depth = options_.depth}, progress_); });
    if (samples_surface(options_.method)) start_from(std::move(input));
    make_tree();
    stage("covering", [&] {
      if (options_.method == TreeMethod::octree) return;  // nothing is open, as require_proof() finds
      const bool grows = options_.method == TreeMethod::merging && options_.closing == MergeClosing::growth;
      build_.cover = grows ? grow_to_cover(build_.tree, surface_, kGrowthFactor, progress_)
                           : cover(build_.tree, surface_, progress_);
    });
    const SphereTree whole = build_.tree;
    stage("redundant spheres",
          [&] { build_.redundancy = remove_redundant(build_.tree, surface_, options_.redundancy, progress_); });
    if (options_.anneal) stage("annealing afterwards", [&] { anneal(); });
    if (options_.descent > 0) stage("random descent", [&] { descend(); });
    if (in_frame(options_)) framed_.take_out(build_.tree);
    framed_.take_out(build_.octree);
    stage("measuring", [&] {
      measure(build_.tree, given_, progress_);
      measure_inaccuracy(build_.octree, given_, progress_, build_.tree);
      if (is_compared() && build_.redundancy.removed > 0 && detail::is_loosened(build_.tree, build_.octree))
        put_back(whole);
    });
    stage("packing and verifying", [&] { require_proof(); });
    return std::move(build_);
  }

 private:
  template <class Function>
  void stage(const char* name, Function&& function) {
    time_stage(build_.seconds, name, std::forward<Function>(function));
  }

  static bool in_frame(const SphereTreeOptions& options) { return options.method != TreeMethod::merging; }

  // Points of the surface, and the axis unless the tree does without.
  void start_from(MedialBuildInput input) {
    MedialBuildOptions medial = options_.medial;
    if (options_.samples_by_need) {
      const Index samples = samples_needed(options_);
      medial.sampling.edge_points = samples / 5;
      medial.sampling.face_points = samples - samples / 5;
    }
    if (options_.method == TreeMethod::merging) return make_axis(medial, std::move(input));
    const bool imports = input.mesh.has_value();
    if (!imports) take_points(medial, input);
    if (imports || options_.axis) make_axis(medial, std::move(input));
    if (imports) sampling_ = framed_.in(build_.medial->sampling);
  }

  // Those of the input, or else new ones, which become the axis' as well: but not if it is to add to them.
  void take_points(const MedialBuildOptions& options, MedialBuildInput& input) {
    if (!given_.solid())
      throw InputError("a tightened tree needs a solid: " + given_.report().faults() + "; repair the mesh first");
    stage("surface points", [&] {
      if (const SurfaceSampling* given = points_of(input)) {
        validate(*given, given_);
        sampling_ = framed_.in(*given);
      } else {
        sampling_ = sample_surface(surface_, options.sampling, progress_);
        if (options_.axis && !options.refine) input.sampling = framed_.out(sampling_);
      }
    });
    build_.points = sampling_.size();
  }

  static const SurfaceSampling* points_of(const MedialBuildInput& input) {
    if (input.sampling) return &*input.sampling;
    return input.diagram ? &input.diagram->sampling : nullptr;
  }

  void make_axis(const MedialBuildOptions& options, MedialBuildInput input) {
    build_.medial = build_medial_axis(given_, options, progress_, std::move(input));
    build_.points = build_.medial->points;
    for (const auto& [name, seconds] : build_.medial->seconds) add_seconds(name, seconds);
    connected_components(build_.medial->axis, build_.axis_components);
  }

  void add_seconds(const std::string& name, double seconds) {
    const auto same = [&](const auto& stage) { return stage.first == name; };
    const auto stage = std::find_if(build_.seconds.begin(), build_.seconds.end(), same);
    if (stage == build_.seconds.end())
      build_.seconds.emplace_back(name, seconds);
    else
      stage->second += seconds;
  }

  template <class Build, class Report>
  void keep(Build made, Report& report) {
    build_.tree = std::move(made.tree);
    report = std::move(made.report);
  }

  void make_tree() {
    const SphereTreeOptions& o = options_;
    switch (o.method) {
      case TreeMethod::octree:
        stage("octree", [&] {
          const bool is_plain = o.branching == 8 && o.refinement.error == 0 && o.refinement.regions.empty();
          build_.tree = is_plain ? build_.octree : octree(surface_, {o.depth, o.refinement, o.branching}, progress_);
        });
        break;
      case TreeMethod::merging:
        stage("merging", [&] {
          const MergeOptions merging{o.depth, o.branching, o.refinement, o.closing};
          keep(merge_tree(surface_, build_.medial->axis, merging, progress_), build_.merging);
        });
        break;
      case TreeMethod::annealing:
        stage("annealing", [&] { keep(annealed_tree(surface_, annealing_options(o), progress_), build_.annealing); });
        break;
      case TreeMethod::tightened:
        stage("tightening", [&] {
          keep(detail::tightened_in_frame(surface_, sampling_, tightening_options(o), progress_), build_.tightening);
        });
        break;
    }
  }

  void anneal() {
    if (options_.method == TreeMethod::annealing) return;
    build_.annealing = anneal_tree(build_.tree, surface_, annealing_options(options_), progress_);
    build_.redundancy.removed += remove_redundant(build_.tree, surface_, options_.redundancy, progress_).removed;
  }

  void descend() {
    build_.descent = random_descent(build_.tree, surface_, {options_.descent, options_.seed}, progress_);
    build_.redundancy.removed += remove_redundant(build_.tree, surface_, options_.redundancy, progress_).removed;
  }

  // Whether no level may be looser than the one above it or than the octree's.
  bool is_compared() const {
    return options_.method == TreeMethod::tightened && options_.descent == 0 && !options_.anneal &&
           detail::goes_on_everywhere(options_.refinement);
  }

  void put_back(const SphereTree& whole) {
    build_.tree = whole;
    framed_.take_out(build_.tree);
    measure(build_.tree, given_, progress_);
    build_.redundancy = {};
  }

  // What is returned has passed verify(). Very far from the origin the given surface's last digits may be too coarse
  // for a tree that was closed in the frame.
  void require_proof() {
    ProvenTree proven = pack_proven(build_.tree, given_, progress_);
    if (proven.proof.triangles_uncovered > 0 && in_frame(options_)) {
      cover(build_.tree, given_, progress_);
      measure(build_.tree, given_, progress_);
      proven = pack_proven(build_.tree, given_, progress_);
    }
    const Verification& proof = proven.proof;
    if (!proof.ok())
      throw Error("the packed tree is not proven to be conservative: " + std::to_string(proof.triangles_uncovered) +
                  " triangles uncovered, " + std::to_string(proof.triangles_unlisted) + " not listed, " +
                  std::to_string(proof.bounds_violated) + " bounds missed");
    build_.packed = std::move(proven.packed);
    build_.certificate = std::move(proven.proof);
    build_.bounds_weakened = static_cast<Index>(proven.weakened.size());
  }

  const Surface& given_;
  const detail::FramedSurface framed_;
  const Surface& surface_;  // that the tree is built on
  SphereTreeOptions options_;
  const Progress& progress_;
  SurfaceSampling sampling_;  // in the frame
  SphereTreeBuild build_;
};

}  // namespace

AnnealingOptions annealing_options(const SphereTreeOptions& o) {
  AnnealingOptions annealing;
  annealing.depth = o.depth;
  annealing.branching = o.branching;
  annealing.energy = o.energy;
  annealing.distance = o.distance;
  annealing.refinement = o.refinement;
  annealing.seed = o.seed;
  if (o.redundancy == Selection::independent) annealing.redundancy = Selection::independent;
  if (o.effort != Effort::high) {
    const bool low = o.effort == Effort::low;
    annealing.max_accepted = annealing.max_rejected = low ? 30 : 60;
    annealing.iterations_first = low ? 40 : 80;
    annealing.iterations = low ? 20 : 30;
    annealing.cooling = low ? 0.8 : 0.85;
  }
  if (o.method != TreeMethod::annealing) annealing.first_acceptance = kCoolStart;
  const auto set = [](auto& number, const auto& given) { number = given.value_or(number); };
  const AnnealingTuning& t = o.annealing;
  set(annealing.move, t.move);
  set(annealing.min_scale, t.min_scale);
  set(annealing.max_scale, t.max_scale);
  set(annealing.first_trials, t.first_trials);
  set(annealing.first_acceptance, t.first_acceptance);
  set(annealing.max_accepted, t.max_accepted);
  set(annealing.max_rejected, t.max_rejected);
  set(annealing.max_uncovering, t.max_uncovering);
  set(annealing.cooling, t.cooling);
  set(annealing.iterations_first, t.iterations_first);
  set(annealing.iterations, t.iterations);
  return annealing;
}

bool samples_surface(TreeMethod method) { return method == TreeMethod::tightened || method == TreeMethod::merging; }

Index samples_needed(const SphereTreeOptions& options) {
  if (options.method != TreeMethod::tightened) return 5000;
  const double leaves = options.spheres.empty() ? std::pow(static_cast<double>(options.branching), options.depth)
                                                : static_cast<double>(options.spheres.back());
  return static_cast<Index>(std::clamp(kSamplesPerLeaf * leaves, 10'000.0, 200'000.0));
}

void require_sizes(const SphereTreeOptions& options) {
  if (options.method == TreeMethod::tightened) return require_sizes(tightening_options(options));
  if (options.branching < 2 || options.branching > kMaxFanOut)
    throw InputError("branching must lie between 2 and " + std::to_string(kMaxFanOut));
}

SphereTreeBuild build_sphere_tree(const Surface& surface, const SphereTreeOptions& options, const Progress& progress,
                                  MedialBuildInput input) {
  require_sizes(options);
  return TreeBuilder(surface, options, progress).run(std::move(input));
}

}  // namespace orchard
