#pragma once
#include "orchard/voronoi/diagram.h"

// A judge of Voronoi diagrams that shares nothing with voronoi/: every point against every sphere and every facet of
// the hull, with spheres and planes computed from the forming points alone, in rational numbers wherever doubles could
// be off. O(n^2).
namespace orchard::test {

struct Judgement {
  double deepest = 0;                   // how deep a point lies in a sphere, over the bounding radius; 0 if in none
  double beyond = 0;                    // how far a point lies beyond a facet of the hull, likewise
  Index sphere = kNone, facet = kNone;  // vertices where that is
  Index flat = 0;                       // vertices and facets without a sphere or plane: exactly flat
  Index missing = 0;                    // points that form no vertex, and coincide with none that does
};

Judgement judge(const VoronoiDiagram& diagram);

}  // namespace orchard::test
