#include "orchard/medial/build.h"

#include <chrono>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

class Stages {
 public:
  explicit Stages(MedialBuild& build) : build_(build) {}
  template <class Function>
  void operator()(const char* name, Function&& function) {
    const auto start = std::chrono::steady_clock::now();
    function();
    build_.seconds.emplace_back(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

 private:
  MedialBuild& build_;
};

void require_solid(const Surface& surface) {
  if (!surface.solid())
    throw InputError("the medial axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
}

// From build.sampling and its diagram.
void find_axis(const Surface& surface, const VoronoiDiagram& diagram, const MedialBuildOptions& options,
               const Progress& progress, MedialBuild& build, Stages& stage) {
  stage("medial axis", [&] {
    build.voronoi_vertices = static_cast<Index>(diagram.vertices.size());
    build.axis = medial_axis(surface, build.sampling, diagram, progress, options.axis);
    build.unpruned_vertices = build.axis.size();
  });
  stage("pruning", [&] { build.axis = prune(build.axis, options.prune); });
}

}  // namespace

MedialBuild build_medial_axis(const Surface& surface, const MedialBuildOptions& options, const Progress& progress,
                              std::optional<SurfaceSampling> own) {
  require_solid(surface);
  MedialBuild build;
  Stages stage(build);
  VoronoiDiagram diagram;
  stage("surface points", [&] {
    build.sampling = own ? std::move(*own) : sample_surface(surface, options.sampling, progress);
    build.points = build.sampling.size();
  });
  stage("Voronoi diagram", [&] { diagram = highest_first_voronoi(build.sampling.points, progress, &build.voronoi); });
  if (options.mend_gaps) {
    stage("gap repair", [&] {
      Repaired repaired =
          repair_gap_crossings(surface, std::move(build.sampling), std::move(diagram), options.repair, progress);
      build.sampling = std::move(repaired.sampling);
      build.repair = std::move(repaired.report);
      diagram = std::move(repaired.diagram);
    });
  }
  find_axis(surface, diagram, options, progress, build, stage);
  return build;
}

MedialBuild build_medial_axis(const Surface& surface, const OwnDiagram& own, const MedialBuildOptions& options,
                              const Progress& progress) {
  require_solid(surface);
  MedialBuild build;
  Stages stage(build);
  build.sampling = own.sampling;
  build.points = build.sampling.size();
  find_axis(surface, own.diagram, options, progress, build, stage);
  return build;
}

}  // namespace orchard
