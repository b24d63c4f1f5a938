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

namespace orchard {

// All that can be tuned on the way from a surface to a medial axis.
struct MedialBuildOptions {
  SamplingOptions sampling = {};
  VoronoiAlgorithm algorithm = VoronoiAlgorithm::highest_first;
  bool repair_gaps = true;  // repair gap crossings; gap_repair says how
  GapRepairOptions gap_repair = {};
  AxisOptions axis{.keep_topology = true};
  PruneOptions prune = {};
  std::optional<RefineOptions> refine = {};  // nothing: the axis stays as the diagram has it; an imported one always
  // How often surface points are added where the refined axis leaves the surface open by more than its border loss, as
  // it does where the solid is thinner than the points' spacing, and everything is rebuilt: each time takes as long as
  // the first. Not where these and what gap repair added are less than a thirty-second of the points and triangles
  // reach for them (RefineOptions) down to three border losses or less: nearly as good, and faster. Not with own
  // points, nor with an own diagram.
  int open_rounds = 1;
  // Compare the finished axis with axis_promise(). Costs about as much as one of the rounds that look for open places.
  bool check_promise = true;
};

// A diagram that the caller made, and where its points lie on the surface; the points of both are the same.
struct OwnDiagram {
  VoronoiDiagram diagram;
  SurfaceSampling sampling;
};

// What stands in for the first steps of a build; at most one of them.
struct MedialBuildInput {
  std::optional<SurfaceSampling> sampling;  // the points, instead of sampled ones: validate() passes, no two coincide
  std::optional<OwnDiagram> diagram;        // the points and their diagram; its gaps are not repaired
  std::optional<MedialMesh> mesh;           // the axis itself, of any system, see import_axis()
};

// Everything that a build made, and how long each stage took.
struct MedialBuild {
  SurfaceSampling sampling;  // with the points that gap repair added, or an imported axis's contacts
  Index points = 0;          // before
  InsertionReport voronoi;
  VoronoiDiagram diagram;  // empty for an imported axis
  GapRepairReport gap_repair;
  Index unpruned_vertices = 0;
  MedialAxis axis;                              // refined, if that was asked for
  RefineReport refinement;                      // zeros, if not
  std::vector<std::array<Index, 2>> features;   // edges of the mesh that sheets reach to, by its vertices, if refined
  PromiseCheck promise;                         // what was promised, and whether it holds; if that was asked for
  Index open_places = 0;                        // points added where a refined axis left the surface open
  Index balls_refused = 0, balls_adjusted = 0;  // of an imported axis, see ImportedAxis
  double ball_adjustment = 0;
  StageTimes seconds;  // stage, time
};

// The main line from a solid to its medial axis: points, Voronoi diagram, gap repair, axis, pruning, refining. The time
// goes as the parts': about n log n in the points, for each of the rounds. Throws InputError unless surface.solid(), if
// an option is out of range, or if `input` has more than one of its values.
MedialBuild build_medial_axis(const Surface& surface, const MedialBuildOptions& options = {},
                              const Progress& progress = {}, MedialBuildInput input = {});

// What build_medial_axis() promises of an axis that it builds, and does not import. By `options`:
// - a refined axis leaves no place of the surface open by more than 1.65 times the larger of border_loss and tolerance,
//   or what so few points can show (RefineOptions::reach_detail) if that is more, and once the tolerance on top, unless
//   reach_rounds is 0 or pruning is asked for;
// - it sticks out of the solid by twice the tolerance at most: interpolated balls are held to the tolerance at places
//   between which they may be off by another one;
// - axis.keep_topology promises the topology of the solid, refined or not.
// `points`: how many surface points it was built from.
AxisPromise axis_promise(const Surface& surface, const MedialBuildOptions& options, Index points);

// The pass of gap repair that added each surface point, from 1 on, counted in the last round; 0 for points that the
// sampling had. -1 is unknown: for what earlier rounds added, at open places and by gap repair, and for all that was
// added where thinning took points out again. O(n).
std::vector<int> repair_passes(const MedialBuild& build);

}  // namespace orchard
