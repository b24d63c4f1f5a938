#include "pipeline.h"

#include "console.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/certify.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/redundancy.h"

namespace orchard::apps {
namespace {

class Pipeline {
 public:
  Pipeline(const Surface& surface, const BuildOptions& options, const Progress& progress)
      : surface_(surface), options_(options), progress_(progress) {}

  BuildResult run() {
    stage("octree", [&] { result_.octree = octree(surface_, {.depth = options_.depth}, progress_); });
    if (options_.method == Method::octree) {
      result_.tree = result_.octree;
    } else {
      build_medial_axis();
      stage("merging", [&] {
        const MergeOptions merging{.depth = options_.depth, .branching = options_.branching};
        result_.tree = merge_tree(surface_, *result_.axis, merging, progress_);
      });
    }
    stage("covering", [&] { result_.cover = cover(result_.tree, surface_, progress_); });
    stage("redundant spheres",
          [&] { result_.redundancy = remove_redundant(result_.tree, surface_, Selection::exhaustive, progress_); });
    stage("measuring", [&] {
      measure(result_.tree, surface_, progress_);
      measure(result_.octree, surface_, progress_);
    });
    stage("packing", [&] { result_.packed = pack(result_.tree, surface_); });
    stage("certifying", [&] { require_certificate(); });
    return std::move(result_);
  }

 private:
  template <class Function>
  void stage(const char* name, Function&& function) {
    const Stopwatch watch;
    function();
    result_.seconds.emplace_back(name, watch.seconds());
  }

  void build_medial_axis() {
    VoronoiDiagram diagram;
    stage("surface points", [&] {
      const SamplingOptions sampling{.face_points = options_.samples - options_.samples / 5,
                                     .edge_points = options_.samples / 5,
                                     .seed = options_.seed};
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

  void require_certificate() const {
    const Coverage coverage = certify(surface_, result_.packed, progress_);
    if (coverage.complete()) return;
    throw Error("the packed tree does not cover the surface: " + std::to_string(coverage.uncovered.size()) +
                " triangles, the first is " + std::to_string(coverage.uncovered[0].triangle));
  }

  const Surface& surface_;
  const BuildOptions& options_;
  const Progress& progress_;
  BuildResult result_;
};

}  // namespace

BuildResult run_pipeline(const Surface& surface, const BuildOptions& options, const Progress& progress) {
  if (options.method == Method::octree && options.branching != 8)
    throw InputError("--branching: an octree has 8 children; use --method medial for another number");
  return Pipeline(surface, options, progress).run();
}

}  // namespace orchard::apps
