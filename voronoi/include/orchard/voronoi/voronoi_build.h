#pragma once
#include "orchard/voronoi/diagram.h"
#include "orchard/voronoi/insertion_report.h"

// The result type of the four Voronoi algorithms.
namespace orchard {

// A Voronoi diagram, and how it was built.
struct VoronoiBuild {
  VoronoiDiagram diagram;
  InsertionReport report;
};

}  // namespace orchard
