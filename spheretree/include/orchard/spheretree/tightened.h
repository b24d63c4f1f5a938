#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

enum class Effort { low, standard, high };  // about 1 : 2 : 15 in time

// What a level's balls are judged by, as sums of powers of the inaccuracy. balanced: a high power at the top, low ones
// below that rise steeply beyond two or three times the mean; maximum and mean weigh more for the one or the other;
// volume stands for the volume outside the object.
enum class Objective { balanced, maximum, mean, volume };

struct TightenOptions {
  Index depth = 3;      // levels below the root at most
  Index branching = 8;  // a level has at most this many times the nodes of the one above; 2..64
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;
  Refinement refinement{};
  std::uint64_t seed = 1;
};

struct TightenReport {
  struct Level {
    Index balls = 0;
    Index closing_rounds = 0;
    Index uncovered_regions = 0;  // that the samples had left, in the first round of closing
    double grown = 0;             // by the last resort, cover(): the largest growth, as a fraction of R
    double seconds_search = 0, seconds_closing = 0;
  };
  std::vector<Level> levels;
};

// The tightest trees: each level is solved as a whole, level_balls = branching^level of them for the whole surface,
// with every ball free to choose its parent. A parent so has one to twice `branching` children (at most 64), and the
// load balances itself. Balls are fitted to surface points by max |p - c| + sd(c), improved by Lloyd's iteration and
// large-neighbourhood search, and closed with the boundary lemma: what no path region holds is given to the ball that
// it costs least, until nothing is left. Then each ball is fitted again to exactly what it alone holds, and the search
// goes on with nothing uncovered. The result is conservative. Deterministic by counted work. Uses the axis's
// surface points as samples: 20 or more for each ball of the last level. Throws InputError for a branching out of range
// or an axis without vertices.
SphereTree tightened_tree(const Surface& surface, const MedialAxis& axis, const TightenOptions& options = {},
                          const Progress& progress = {}, TightenReport* report = nullptr);

}  // namespace orchard
