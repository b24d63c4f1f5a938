#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

struct CoverReport {
  int rounds = 0;
  Index triangles_uncovered = 0;  // before the first round
  double max_growth = 0;          // of a radius, as a fraction of R
};

// Makes a tree conservative by the path rule (dissertation 6.3.2): finds what the boundary lemma cannot certify, and
// grows the balls of the path that needs to grow least, until every triangle is certified. Throws Error if the
// certificate is still incomplete after a fixed number of rounds.
CoverReport cover(SphereTree& tree, const Surface& surface, const Progress& progress = {});

// The same as dissertation 6.3.2 has it: in every round, the spheres that have an uncovered boundary in some triangle
// grow by the factor; where a triangle has none, the nearest leaf and what is above it. cover() grows less, since it
// grows one path for each region, and only as far as it must.
CoverReport grow_to_cover(SphereTree& tree, const Surface& surface, double factor = 1.1, const Progress& progress = {});

}  // namespace orchard
