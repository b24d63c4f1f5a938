#pragma once
#include "orchard/voronoi/diagram.h"
#include "orchard/voronoi/insertion_report.h"

namespace orchard {

// What the four algorithms give back: a diagram, and what it took to make it.
struct VoronoiBuild {
  VoronoiDiagram diagram;
  InsertionReport report;
};

}  // namespace orchard
