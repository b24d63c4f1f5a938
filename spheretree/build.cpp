#include "orchard/spheretree/build.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "canonical_frame.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/proven.h"
#include "tightened/tightened_in_frame.h"
#include "tightened/tree_looseness.h"

namespace orchard {
namespace {

constexpr double kSamplesPerLeaf = 20;
constexpr double kGrowthFactor = 1.1;  // of dissertation 6.3.2

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // which Clang does not deduce by itself before version 17

const Refinement& refinement_of(const TreeOptions& options) {
  return std::visit([](const auto& of_method) -> const Refinement& { return of_method.refinement; }, options);
}

bool is_plain(const OctreeOptions& options) {
  return options.branching == 8 && options.refinement.error == 0 && options.refinement.regions.empty();
}

// Builds trees in the surface's canonical frame, so that they do not depend on the surface's place and size. Only
// merged trees are built on the surface as given, because they start from its medial axis.
class TreeBuilder {
 public:
  TreeBuilder(const Surface& surface, const SphereTreeOptions& options, const Progress& progress)
      : given_(surface),
        framed_(surface),
        method_(method_of(options.tree)),
        surface_(in_frame() ? framed_.surface() : surface),
        options_(options),
        progress_(progress) {
    build_.tree_options = options.tree;
    if (in_frame())
      std::visit([&](auto& of_method) { of_method.refinement = framed_.in(of_method.refinement); }, options_.tree);
  }

  SphereTreeBuild run(MedialBuildInput input) {
    stage("octree to compare with",
          [&] { build_.octree = octree(framed_.surface(), {.depth = depth_of(options_.tree)}, progress_); });
    if (samples_surface(method_)) start_from(std::move(input));
    make_tree();
    stage("covering", [&] {
      if (method_ == TreeMethod::octree) return;  // it covers the surface by construction; require_proof() checks that
      const auto* merging = std::get_if<MergeOptions>(&options_.tree);
      const bool grows = merging != nullptr && merging->closing == MergeClosing::growth;
      build_.cover = grows ? grow_to_cover(build_.tree, surface_, kGrowthFactor, progress_)
                           : cover(build_.tree, surface_, progress_);
    });
    const SphereTree whole = build_.tree;
    stage("redundant spheres",
          [&] { build_.redundancy = remove_redundant(build_.tree, surface_, options_.redundancy, progress_); });
    if (options_.anneal) stage("annealing afterwards", [&] { anneal(); });
    if (options_.descent) stage("random descent", [&] { descend(); });
    if (in_frame()) framed_.take_out(build_.tree);
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

  bool in_frame() const { return method_ != TreeMethod::merging; }

  // Makes the surface points, and the medial axis if the tree needs one.
  void start_from(MedialBuildInput input) {
    MedialBuildOptions medial = options_.medial;
    if (options_.samples_by_need) {
      const Index samples = samples_needed(options_.tree);
      medial.sampling.edge_points = samples / 5;
      medial.sampling.face_points = samples - samples / 5;
    }
    if (method_ == TreeMethod::merging) return make_axis(medial, std::move(input));
    const bool imports = input.mesh.has_value();
    if (!imports) take_points(medial, input);
    if (imports || options_.axis) make_axis(medial, std::move(input));
    if (imports) sampling_ = framed_.in(build_.medial->sampling);
  }

  // Takes the points of the input. If there are none, samples new ones, which the axis uses, too, unless it adds
  // points.
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
    std::visit(
        Overloaded{[&](const OctreeOptions& octree_options) {
                     stage("octree", [&] {
                       build_.tree =
                           is_plain(octree_options) ? build_.octree : octree(surface_, octree_options, progress_);
                     });
                   },
                   [&](const MergeOptions& merging) {
                     stage("merging", [&] {
                       keep(merge_tree(surface_, build_.medial->axis, merging, progress_), build_.merging);
                     });
                   },
                   [&](const AnnealingOptions& annealing) {
                     stage("annealing", [&] { keep(annealed_tree(surface_, annealing, progress_), build_.annealing); });
                   },
                   [&](const TightenOptions& tightening) {
                     stage("tightening", [&] {
                       keep(detail::tightened_in_frame(surface_, sampling_, tightening, progress_), build_.tightening);
                     });
                   }},
        options_.tree);
  }

  void anneal() {
    if (method_ == TreeMethod::annealing) return;
    build_.annealing = anneal_tree(build_.tree, surface_, *options_.anneal, progress_);
    build_.redundancy.removed += remove_redundant(build_.tree, surface_, options_.redundancy, progress_).removed;
  }

  void descend() {
    build_.descent = random_descent(build_.tree, surface_, *options_.descent, progress_);
    build_.redundancy.removed += remove_redundant(build_.tree, surface_, options_.redundancy, progress_).removed;
  }

  // Whether the tree must be such that no level is looser than the level above or than the octree's level.
  bool is_compared() const {
    return method_ == TreeMethod::tightened && !options_.descent && !options_.anneal &&
           detail::goes_on_everywhere(refinement_of(options_.tree));
  }

  void put_back(const SphereTree& whole) {
    build_.tree = whole;
    framed_.take_out(build_.tree);
    measure(build_.tree, given_, progress_);
    build_.redundancy = {};
  }

  // Packs the tree and proves that it is conservative; a tree without proof is never returned. If the surface lies very
  // far from the origin, rounding may have opened a tree that was closed in the frame: it is covered once more.
  void require_proof() {
    ProvenTree proven = pack_proven(build_.tree, given_, progress_);
    if (proven.proof.triangles_uncovered > 0 && in_frame()) {
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
  const TreeMethod method_;
  const Surface& surface_;  // the surface that the tree is built on: in the frame, or as given
  SphereTreeOptions options_;
  const Progress& progress_;
  SurfaceSampling sampling_;  // in the frame
  SphereTreeBuild build_;
};

}  // namespace

TreeMethod method_of(const TreeOptions& options) {
  return std::visit(Overloaded{[](const TightenOptions&) { return TreeMethod::tightened; },
                               [](const MergeOptions&) { return TreeMethod::merging; },
                               [](const AnnealingOptions&) { return TreeMethod::annealing; },
                               [](const OctreeOptions&) { return TreeMethod::octree; }},
                    options);
}

Index depth_of(const TreeOptions& options) {
  const auto* tightened = std::get_if<TightenOptions>(&options);
  if (tightened != nullptr && !tightened->spheres.empty()) return static_cast<Index>(tightened->spheres.size());
  return std::visit([](const auto& of_method) { return of_method.depth; }, options);
}

bool samples_surface(TreeMethod method) { return method == TreeMethod::tightened || method == TreeMethod::merging; }

Index samples_needed(const TreeOptions& options) {
  const auto* tightened = std::get_if<TightenOptions>(&options);
  if (tightened == nullptr) return 5000;
  const double leaves = tightened->spheres.empty()
                            ? std::pow(static_cast<double>(tightened->branching), tightened->depth)
                            : static_cast<double>(tightened->spheres.back());
  return static_cast<Index>(std::clamp(kSamplesPerLeaf * leaves, 10'000.0, 200'000.0));
}

void require_sizes(const TreeOptions& options) {
  if (const auto* tightened = std::get_if<TightenOptions>(&options)) return require_sizes(*tightened);
  const Index branching = std::visit([](const auto& of_method) { return of_method.branching; }, options);
  if (branching < 2 || branching > kMaxFanOut)
    throw InputError("branching must lie between 2 and " + std::to_string(kMaxFanOut));
}

SphereTreeBuild build_sphere_tree(const Surface& surface, const SphereTreeOptions& options, const Progress& progress,
                                  MedialBuildInput input) {
  require_sizes(options.tree);
  return TreeBuilder(surface, options, progress).run(std::move(input));
}

}  // namespace orchard
