#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orchard/medial/axis.h"
#include "orchard/medial/gap_crossing.h"
#include "orchard/medial/prune.h"
#include "orchard/voronoi/highest_first.h"

namespace orchard {

// All that can be tuned on the way from a surface to a medial axis.
struct MedialBuildOptions {
  SamplingOptions sampling = {};
  bool mend_gaps = true;
  RepairOptions repair = {};
  AxisOptions axis{.keep_topology = true};
  PruneOptions prune = {};
};

struct MedialBuild {
  SurfaceSampling sampling;  // with the points that gap repair added
  Index points = 0;          // before
  InsertionReport voronoi;
  Index voronoi_vertices = 0;
  RepairReport repair;
  Index unpruned_vertices = 0;
  MedialAxis axis;
  std::vector<std::pair<std::string, double>> seconds;  // of each stage
};

// A diagram that the caller made, and where its points lie on the surface; the points of both are the same.
struct OwnDiagram {
  VoronoiDiagram diagram;
  SurfaceSampling sampling;
};

// Points, Voronoi diagram, gap repair, axis, pruning. `own`: the caller's points instead of sampled ones (validate()
// passes, no two coincide). Throws InputError unless surface.solid(), or if an option is out of range.
MedialBuild build_medial_axis(const Surface& surface, const MedialBuildOptions& options = {},
                              const Progress& progress = {}, std::optional<SurfaceSampling> own = {});

// Axis and pruning alone: the diagram is taken as it is, its gaps are not repaired.
MedialBuild build_medial_axis(const Surface& surface, const OwnDiagram& own, const MedialBuildOptions& options = {},
                              const Progress& progress = {});

}  // namespace orchard
