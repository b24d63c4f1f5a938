#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

// Finds and repairs gap crossings: faces of Voronoi cells that cross the surface between parts that are not joined
// there.
namespace orchard {

// The parts of the surface that a Voronoi cell may meet without being gap-crossing.
enum class GapDefinition : std::uint8_t {
  // The part of the surface inside the cell that is connected to the cell's point. This needs no scale and suits
  // polyhedra and scans.
  connected,
  // The clusters that contain the cell's point, and the clusters that adjoin these (dissertation 6.2.4). It misses gaps
  // between two clusters that adjoin the same third one. On scans, where each triangle is a cluster, it finds crossings
  // nearly everywhere.
  loose,
  // The clusters that contain the cell's point.
  strict,
};

// The options of repair_gap_crossings().
struct GapRepairOptions {
  // The maximum number of passes. The limit matters where new points on one side of a V or U cause crossings on the
  // other side, again and again.
  int max_passes = 20;
  // A crossing also counts as harmless if the surface joins the crossed triangle to the triangles of both points inside
  // a ball. The ball is around the middle of the points, and its radius is this many times their distance. 0 repairs
  // every crossing; 2 leaves small valleys.
  double joined_radius = 0;
  GapDefinition definition = GapDefinition::connected;
  // Whether cells that contain a whole ring of a part thinner than the spacing of the points are repaired, too. This
  // works only with the connected definition and joined_radius 0, because harmless crossings look like necks.
  bool mend_necks = true;
  // Whether crowded pairs of points are removed after the repair. Where a part is thinner than the spacing of its
  // points, every point needs another one on the opposite side, which doubles the points. Thinning removes such pairs,
  // points of the sampling included, and repairs the crossings that this causes, as long as it saves points. The result
  // has the same topology with fewer points, but may lose points on edges.
  bool thin = false;
};

// The counts of one pass.
struct GapRepairPass {
  // The cells that were tested when the pass began, and those of them that cross. Cells that no new point touched are
  // not tested again, and neither are their faces.
  Index cells_tested = 0, cells_crossing = 0;
  Index faces_tested = 0, faces_crossing = 0;  // Faces of all cells; a face shared by two cells counts once.
  // The points that were added opposite the cell's point (a projection onto the crossed sheet), at the nearest place of
  // the crossed part of the surface, and at necks; and the points that were not added because another point is there.
  Index added_by_projection = 0, added_by_snapping = 0, added_at_necks = 0, refused_as_coincident = 0;
  // The number of boxes and points that the search for near new points visits. It measures the cost of choosing places
  // for points, independently of the machine.
  std::size_t steps_among_new_points = 0;
};

// The counts of all passes.
struct GapRepairReport {
  std::vector<GapRepairPass> passes;
  Index points_added = 0;          // Added points that are present at the end.
  Index points_removed = 0;        // Points of the sampling that thinning removed.
  Index faces_still_crossing = 0;  // The faces that cross at the final check of all cells.
  // The number of these faces at which triangles that cut each other meet one cell. Repair does not change them, since
  // sheets that cross have no gap between them.
  Index faces_at_cuts = 0;
};

// The repaired sampling with its diagram.
struct GapRepair {
  SurfaceSampling sampling;
  VoronoiDiagram diagram;
  GapRepairReport report;
};

// Repairs gap crossings: finds faces of Voronoi cells that cross the surface where they should not, and adds surface
// points that cut the crossings off, until there are none or max_passes passes are done.
// With the default definition, a result without crossings has one disk of surface for each cell, one arc for each pair
// of neighbours and one point for each triple. So the Voronoi edges that stay inside have the topology of the solid
// (Edelsbrunner and Shah 1997).
// Preconditions: diagram.points equals sampling.points, and highest_first_voronoi() built the diagram. Throws
// InputError unless surface.solid(), or if the diagram cannot be that of the sampling. Takes O(n log n) for each pass
// on all but pathological inputs. The work is parallel, with the same result on any number of threads. Source:
// dissertation 6.2.4.
GapRepair repair_gap_crossings(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram,
                               const GapRepairOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
