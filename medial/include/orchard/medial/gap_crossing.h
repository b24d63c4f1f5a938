#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

namespace orchard {

// Where a Voronoi cell may meet the surface without being gap-crossing.
enum class GapDefinition : std::uint8_t {
  connected,  // where the cell's own part of the surface joins it to the cell's point: needs no scale, and suits
              // polyhedra and scans alike
  loose,   // on clusters that hold the cell's point or adjoin one that does (dissertation 6.2.4). Blind to gaps between
           // clusters that adjoin the same third; flags nearly everything on scans, where each triangle is a cluster
  strict,  // on clusters that hold the cell's point
};

struct GapRepairOptions {
  // A bounce between the sides of a V or U ends here at the latest.
  int max_passes = 20;
  // A crossing is harmless, too, if the crossed triangle is joined to both points' triangles within the surface, inside
  // the ball around the points' middle of this many times their distance. 0 mends every crossing; 2 leaves small folds.
  double joined_radius = 0;
  GapDefinition definition = GapDefinition::connected;
  // Also where a cell takes in a whole ring of a part thinner than the points' spacing. Only with the connected
  // definition and joined_radius 0: harmless crossings look like necks.
  bool mend_necks = true;
  // Where a part is thinner than its points are apart, every point needs one across, which doubles them. Afterwards
  // take crowded pairs out again, points of the sampling's own among them, and mend what that breaks, as long as it
  // saves points: fewer for the same topology, but points on edges go, too.
  bool thin = false;
};

struct GapRepairPass {
  // What is known when the pass begins. Cells that no new point touched are not tested again, nor their faces.
  Index cells_tested = 0, cells_crossing = 0;
  Index faces_tested = 0, faces_crossing = 0;  // of all cells; each shared one once
  Index added_by_projection = 0, added_by_snapping = 0, added_at_necks = 0, refused_as_coincident = 0;
  // Boxes and points that the search for new points near other new points looked at: the cost of choosing places, in
  // numbers that no machine changes.
  std::size_t steps_among_new_points = 0;
};

struct GapRepairReport {
  std::vector<GapRepairPass> passes;
  Index points_added = 0;          // that are there at the end
  Index points_removed = 0;        // of the sampling's own, by thinning
  Index faces_still_crossing = 0;  // at the final full recheck
  // Of them, those where triangles that cut each other meet one cell: nothing is tried there, since sheets that cross
  // have no gap between them.
  Index faces_at_cuts = 0;
};

struct GapRepair {
  SurfaceSampling sampling;
  VoronoiDiagram diagram;
  GapRepairReport report;
};

// Dissertation 6.2.4: finds faces of Voronoi cells that cross the surface where they should not, and adds surface
// points that cut the crossing off, until none is left or max_passes are done. With the default definition, a result
// without crossings has one disk of surface for each cell, one arc for each two neighbours and one point for each
// three, so that the Voronoi edges that stay inside hang together as the solid does (Edelsbrunner and Shah 1997).
// Preconditions: diagram.points equals sampling.points, highest_first_voronoi made it. Throws InputError unless
// surface.solid(), or if the diagram cannot be that of the sampling. O(n log n) per pass for all but pathological
// inputs; parallel, the same for any thread count.
GapRepair repair_gap_crossings(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram,
                               const GapRepairOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
