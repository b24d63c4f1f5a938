#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

namespace orchard {

struct RepairOptions {
  int max_passes = 20;         // a bounce between the sides of a V or U ends here at the latest
  double joined_radius = 2.0;  // a crossing is harmless if the crossed triangle is joined to both points' triangles
                               // within the surface inside a ball of this many times the points' distance
};

struct RepairPass {
  Index faces_tested = 0, faces_crossing = 0;
  Index added_by_projection = 0, added_by_snapping = 0, refused_as_coincident = 0;
};

struct RepairReport {
  std::vector<RepairPass> passes;
  Index points_added = 0;
  Index faces_still_crossing = 0;  // at the final full recheck
};

struct Repaired {
  SurfaceSampling sampling;
  VoronoiDiagram diagram;
  RepairReport report;
};

// Dissertation 6.2.4: finds faces of Voronoi cells that cross the surface where they should not (the loose definition:
// a crossed cluster neither holds both points nor adjoins the clusters that do), and adds surface points that cut the
// crossing off, until none is left or max_passes are done. Precondition: diagram.points equals sampling.points.
Repaired repair_gap_crossings(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram,
                              const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
