#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

struct CoverReport {
  int rounds = 0;
  Index triangles_uncovered = 0;  // before the first round
  double max_growth = 0;          // of a radius in one step, as a fraction of R
};

// Makes a tree conservative by the path rule: finds what the boundary lemma cannot certify, and grows the balls of the
// path that needs to grow least, until every triangle is certified. Balls only grow, about their centres. Throws Error
// if something is still uncovered after a fixed number of rounds. Balls that grow get `first_margin` of R more than
// they need, and twice as much in every round: a larger one takes fewer rounds, and is worth it where what is uncovered
// is known to be deeper. Balls of levels above `first_level` do not grow unless half of the rounds did not do without:
// for trees that were conservative down to the level before. Source: dissertation 6.3.2, with less growth.
CoverReport cover(SphereTree& tree, const Surface& surface, const Progress& progress = {},
                  double first_margin = tolerance::kCoverMargin, Index first_level = 0);

// Makes a tree conservative as dissertation 6.3.2 has it: in every round, the spheres that have an uncovered boundary
// in some triangle grow by the factor; where a triangle has no such boundary, the nearest leaf and the spheres above it
// do. cover() grows less, since it grows one path for each uncovered region, and only as far as it must. Throws
// InputError unless the factor is above 1, and Error if something is still uncovered after a fixed number of rounds.
CoverReport grow_to_cover(SphereTree& tree, const Surface& surface, double factor = 1.1, const Progress& progress = {});

}  // namespace orchard
