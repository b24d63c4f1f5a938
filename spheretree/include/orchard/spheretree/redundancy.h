#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// Spheres that a tree can do without (dissertation 5.3.4). Everything here takes a tree that is conservative by the
// path rule, whole or cut off below any level, and gives back one: what the boundary lemma cannot prove stays.

// A node that covers nothing of the surface but what its coverers cover too, in the dissertation's sense: balls against
// balls, without what is above and below them.
struct RedundantNode {
  Index node = kNone;
  std::vector<Index> coverers;  // nodes, ascending: the covering rests on these
};
enum class Coverers { siblings, aunts };
// Of the nodes on one level, ascending. Parallel.
std::vector<RedundantNode> redundant_nodes(const SphereTree& tree, const Surface& surface, Index level, Coverers by);

// Which of them may go together. Independent set: none goes that another one rests on; greedy, in order of increasing
// degree. Acyclic: one may rest on another that goes, if that one's coverers stay in the end; nodes are kept until
// nothing rests on itself, on each cycle the one that most others rest on.
std::vector<Index> independent_selection(std::span<const RedundantNode> redundant);
std::vector<Index> acyclic_selection(std::span<const RedundantNode> redundant);

enum class Selection {
  independent,  // by siblings and aunts, as the dissertation built it
  acyclic,      // by siblings and aunts, as it sketched it
  exhaustive,   // whatever the path rule allows: afterwards no node at all can go
};
struct RedundancyReport {
  Index by_siblings = 0, by_aunts = 0;  // found redundant, on all levels; not counted for exhaustive
  Index selected = 0;                   // of them
  Index vetoed = 0;                     // of those: kept because the path rule would not be certain without them
  Index removed = 0;                    // nodes that are gone, with what was below and left empty above them
};

// Removes redundant nodes, from the top level down, loosest first. A removed node takes its subtree with it; a parent
// that loses its last child goes too. The loosest is the one whose centre is farthest out plus its radius.
RedundancyReport remove_redundant(SphereTree& tree, const Surface& surface, Selection selection = Selection::exhaustive,
                                  const Progress& progress = {});

}  // namespace orchard
