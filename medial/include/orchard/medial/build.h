#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orchard/geometry/stage_times.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/gap_crossing.h"
#include "orchard/medial/import_axis.h"
#include "orchard/medial/promise.h"
#include "orchard/medial/prune.h"
#include "orchard/medial/refine.h"
#include "orchard/voronoi/algorithms.h"

// Builds the medial axis of a solid from its surface: surface points, Voronoi diagram, gap repair, axis, refinement and
// pruning in one call.
namespace orchard {

// The options of build_medial_axis(), one group for each stage.
struct MedialBuildOptions {
  SamplingOptions sampling = {};  // The number and spacing of the surface points.
  VoronoiAlgorithm algorithm = VoronoiAlgorithm::highest_first;
  bool repair_gaps = true;  // Whether gap crossings are repaired, with the options in gap_repair.
  GapRepairOptions gap_repair = {};
  AxisOptions axis{.keep_topology = true};
  // If this has no value, the vertices of the axis stay at the Voronoi vertices. An imported axis is never refined.
  std::optional<RefineOptions> refine = {};
  PruneOptions prune = {};  // The finished axis is pruned by these; by default it is not.
  // The maximum number of rounds that add surface points, at least 0. A round adds points where the refined axis leaves
  // the surface open by more than border_loss, which happens where the solid is thinner than the spacing of the points,
  // and then rebuilds the diagram and the axis. Each round takes as long as the first build.
  // A round is skipped if its points and those of gap repair are at most 1/32 of the points, and if refinement reaches
  // for all places that are open by more than three border losses (RefineOptions::reach_rounds): the result is nearly
  // as good, and the build is faster. If the caller supplies the points or the diagram, no round runs.
  int open_rounds = 1;
  // Whether the finished axis is compared with axis_promise(). The check costs about as much as the search for open
  // places in one round.
  bool check_promise = true;
};

// A diagram made by the caller, and the places of its points on the surface. Both members hold the same points in the
// same order.
struct OwnDiagram {
  VoronoiDiagram diagram;
  SurfaceSampling sampling;
};

// Replacements for the first stages of a build. At most one member may have a value.
struct MedialBuildInput {
  // Points that replace the sampled ones. They must pass validate(), and no two may coincide.
  std::optional<SurfaceSampling> sampling;
  // Points with their diagram. The gaps of this diagram are not repaired.
  std::optional<OwnDiagram> diagram;
  // A finished axis from any system, which is imported by import_axis().
  std::optional<MedialMesh> mesh;
};

// The results of all stages of a build, and the time of each stage.
struct MedialBuild {
  // The surface points, with those that gap repair and the rounds for open places added. After an import they include
  // the contacts of the imported axis.
  SurfaceSampling sampling;
  Index points = 0;  // The number of surface points that the first stage made.
  InsertionReport voronoi;
  VoronoiDiagram diagram;  // This is empty for an imported axis.
  GapRepairReport gap_repair;
  Index unpruned_vertices = 0;  // The number of vertices of the axis before it was pruned.
  MedialAxis axis;              // The finished axis, refined if options.refine has a value, and pruned.
  RefineReport refinement;      // All counts are 0 if the axis was not refined.
  // The mesh edges that the sheets of a refined axis reach, each as two vertices of the mesh.
  std::vector<std::array<Index, 2>> features;
  // The promise and the result of its check, if options.check_promise asked for it.
  PromiseCheck promise;
  Index open_places = 0;  // The number of points added where a refined axis left the surface open.
  Index balls_refused = 0, balls_adjusted = 0;  // These three describe an imported axis, see ImportedAxis.
  double ball_adjustment = 0;
  StageTimes seconds;  // The name and the duration of each stage.
};

// Builds the medial axis of a solid in these stages: surface points, Voronoi diagram, gap repair, axis, refinement,
// pruning. `input` may replace the first stages.
// Returns the results of all stages. Throws InputError unless surface.solid(), if an option is out of range, or if more
// than one member of `input` has a value. Throws Cancelled if `progress` returns false. Takes about O(n log n) for n
// surface points in each round.
MedialBuild build_medial_axis(const Surface& surface, const MedialBuildOptions& options = {},
                              const Progress& progress = {}, MedialBuildInput input = {});

// Returns what build_medial_axis() promises of an axis that it builds from these options; nothing is promised of an
// imported axis. `points` is the number of surface points that the axis was built from.
// - A refined axis leaves no place of the surface open by more than L + tolerance, where L is the larger of 1.65
//   max(border_loss, tolerance) and the limit of RefineOptions::reach_detail, below which so few points show no detail.
//   There is no such promise if reach_rounds is 0 or if the axis is pruned.
// - A refined axis protrudes from the solid by at most twice the tolerance. Interpolated balls are within one tolerance
//   where they are checked, and may be off by another one in between.
// - With axis.keep_topology, the axis has the topology of the solid, whether it is refined or not.
AxisPromise axis_promise(const Surface& surface, const MedialBuildOptions& options, Index points);

// Returns, for each surface point, the pass of gap repair that added it, counted from 1 within the last round. The
// value is 0 for points of the sampling. It is -1 where the pass is unknown: for points that earlier rounds added, for
// points added at open places, and for all added points if thinning removed points. O(n).
std::vector<int> repair_passes(const MedialBuild& build);

}  // namespace orchard
