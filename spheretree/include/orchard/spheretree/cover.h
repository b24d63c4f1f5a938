#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/tree.h"

// Grows the spheres of a tree until it covers its surface.
namespace orchard {

// The growth of a tree.
struct CoverReport {
  int rounds = 0;
  Index triangles_uncovered = 0;  // Before the first round.
  double max_growth = 0;          // The largest growth of a radius in one step, as a fraction of R.
};

// Makes a tree conservative by the path rule: finds what the boundary lemma cannot certify, and grows the balls of the
// path that needs the least growth, until every triangle is certified. Balls only grow, about their centres.
// Each ball that grows gets `first_margin` (a fraction of R) more than it needs, and twice as much in each further
// round. A larger value takes fewer rounds, which is useful if the uncovered parts are known to be deeper. Balls of
// levels above `first_level` do not grow in the first half of the rounds; use this for trees that were conservative
// down to the level before.
// Throws Error if something is still uncovered after a fixed number of rounds. Source: dissertation 6.3.2, with less
// growth.
CoverReport cover(SphereTree& tree, const Surface& surface, const Progress& progress = {},
                  double first_margin = tolerance::kCoverMargin, Index first_level = 0);

// Makes a tree conservative as dissertation 6.3.2 does: in each round, the spheres that have an uncovered boundary in
// some triangle grow by the factor; where a triangle has no such boundary, the nearest leaf and the spheres above it
// grow. cover() grows less, since it grows one path for each uncovered region, only as far as necessary.
// Throws InputError unless the factor is above 1, and Error if something is still uncovered after a fixed number of
// rounds.
CoverReport grow_to_cover(SphereTree& tree, const Surface& surface, double factor = 1.1, const Progress& progress = {});

}  // namespace orchard
