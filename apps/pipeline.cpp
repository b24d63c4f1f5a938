#include "pipeline.h"

#include <algorithm>
#include <cmath>

#include "console.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/proven.h"
#include "orchard/spheretree/redundancy.h"

namespace orchard::apps {
namespace {

constexpr double kSamplesPerLeaf = 20;
constexpr double kGrowthFactor = 1.1;  // of dissertation 6.3.2

bool needs_axis(Method method) { return method == Method::tightened || method == Method::merging; }

// The dissertation's schedule, or a share of it.
AnnealingOptions annealing_options(const BuildOptions& o) {
  AnnealingOptions annealing;
  annealing.depth = o.depth;
  annealing.branching = o.branching;
  annealing.energy = o.energy;
  annealing.refinement = o.refinement;
  annealing.seed = o.seed;
  if (o.effort == Effort::high) return annealing;
  const bool low = o.effort == Effort::low;
  annealing.most_accepted = annealing.most_rejected = low ? 30 : 60;
  annealing.iterations_first = low ? 40 : 80;
  annealing.iterations = low ? 20 : 30;
  annealing.cooling = low ? 0.8 : 0.85;
  return annealing;
}

class Pipeline {
 public:
  Pipeline(const Surface& surface, const BuildOptions& options, const Progress& progress)
      : surface_(surface), options_(options), progress_(progress) {}

  BuildResult run() {
    stage("octree to compare with", [&] { result_.octree = octree(surface_, {.depth = options_.depth}, progress_); });
    if (needs_axis(options_.method)) build_medial_axis();
    build_tree();
    stage("covering", [&] {
      const bool grows = options_.method == Method::merging && options_.closing == MergeClosing::growth;
      result_.cover = grows ? grow_to_cover(result_.tree, surface_, kGrowthFactor, progress_)
                            : cover(result_.tree, surface_, progress_);
    });
    stage("redundant spheres",
          [&] { result_.redundancy = remove_redundant(result_.tree, surface_, Selection::exhaustive, progress_); });
    if (options_.descent > 0)
      stage("random descent", [&] {
        const DescentOptions descent{options_.descent, options_.seed};
        result_.descent = random_descent(result_.tree, surface_, descent, progress_);
        result_.redundancy.removed +=
            remove_redundant(result_.tree, surface_, Selection::exhaustive, progress_).removed;
      });
    stage("measuring", [&] {
      measure(result_.tree, surface_, progress_);
      measure(result_.octree, surface_, progress_);
    });
    stage("packing and verifying", [&] { require_proof(); });
    return std::move(result_);
  }

 private:
  template <class Function>
  void stage(const char* name, Function&& function) {
    const Stopwatch watch;
    function();
    result_.seconds.emplace_back(name, watch.seconds());
  }

  void build_tree() {
    const BuildOptions& o = options_;
    switch (o.method) {
      case Method::octree:
        stage("octree", [&] { result_.tree = octree(surface_, {o.depth, o.refinement, o.branching}, progress_); });
        break;
      case Method::merging:
        stage("merging", [&] {
          result_.tree = merge_tree(surface_, *result_.axis, {o.depth, o.branching, o.refinement, o.closing}, progress_,
                                    &result_.merging);
        });
        break;
      case Method::annealing:
        stage("annealing",
              [&] { result_.tree = annealed_tree(surface_, annealing_options(o), progress_, &result_.annealing); });
        break;
      case Method::tightened:
        stage("tightening", [&] {
          const TightenOptions tightening{o.depth, o.branching, o.effort, o.objective, o.refinement, o.seed};
          result_.tree = tightened_tree(surface_, *result_.axis, tightening, progress_, &result_.tightening);
        });
        break;
    }
  }

  void build_medial_axis() {
    VoronoiDiagram diagram;
    const Index samples = options_.samples.value_or(samples_needed(options_));
    stage("surface points", [&] {
      const SamplingOptions sampling{
          .face_points = samples - samples / 5, .edge_points = samples / 5, .seed = options_.seed};
      result_.sampling = sample_surface(surface_, sampling, progress_);
    });
    stage("Voronoi diagram",
          [&] { diagram = highest_first_voronoi(result_.sampling.points, progress_, &result_.voronoi); });
    stage("gap repair", [&] {
      Repaired repaired =
          repair_gap_crossings(surface_, std::move(result_.sampling), std::move(diagram), {}, progress_);
      result_.sampling = std::move(repaired.sampling);
      result_.repair = std::move(repaired.report);
      diagram = std::move(repaired.diagram);
    });
    stage("medial axis", [&] {
      result_.voronoi_vertices = static_cast<Index>(diagram.vertices.size());
      result_.axis = medial_axis(surface_, result_.sampling, diagram, progress_);
      connected_components(*result_.axis, result_.axis_components);
    });
  }

  // What is written has passed `verify`.
  void require_proof() {
    ProvenTree proven = pack_proven(result_.tree, surface_, progress_);
    const Verification& proof = proven.proof;
    if (!proof.ok())
      throw Error("the packed tree is not proven to be conservative: " + std::to_string(proof.triangles_uncovered) +
                  " triangles uncovered, " + std::to_string(proof.triangles_unlisted) + " not listed, " +
                  std::to_string(proof.bounds_violated) + " bounds missed");
    result_.packed = std::move(proven.packed);
    result_.bounds_weakened = static_cast<Index>(proven.weakened.size());
  }

  const Surface& surface_;
  const BuildOptions& options_;
  const Progress& progress_;
  BuildResult result_;
};

}  // namespace

Index samples_needed(const BuildOptions& options) {
  if (options.method != Method::tightened) return 5000;
  const double leaves = std::pow(static_cast<double>(options.branching), options.depth);
  const double least = options.effort == Effort::high ? 20'000 : 10'000;
  return static_cast<Index>(std::clamp(kSamplesPerLeaf * leaves, least, 200'000.0));
}

BuildResult run_pipeline(const Surface& surface, const BuildOptions& options, const Progress& progress) {
  return Pipeline(surface, options, progress).run();
}

}  // namespace orchard::apps
