#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// Spheres that a tree can do without (dissertation 5.3.4). Every function here takes a tree that is conservative by the
// path rule, whole or cut off below any level. Removal keeps it conservative: a sphere stays unless the boundary lemma
// proves that it can go.

// A node that covers nothing of the surface but what its coverers cover too. This is the dissertation's sense: balls
// are compared with balls, whatever is above and below them.
struct RedundantNode {
  Index node = kNone;
  std::vector<Index> coverers;  // nodes, ascending: the covering rests on these
};
enum class Coverers { siblings, aunts };
// The redundant nodes on one level, ascending, by their siblings or by the siblings of their parent. Parallel over
// nodes.
std::vector<RedundantNode> redundant_nodes(const SphereTree& tree, const Surface& surface, Index level, Coverers by);

// Which of the redundant nodes may go together. Independent: no node goes that another one that goes rests on; greedy,
// in order of increasing degree. Acyclic: a node that goes may rest on another that goes, as long as the chain ends in
// nodes that stay; of each cycle, the node that most others rest on is kept.
std::vector<Index> independent_selection(std::span<const RedundantNode> redundant);
std::vector<Index> acyclic_selection(std::span<const RedundantNode> redundant);

enum class Selection {
  independent,  // by siblings and aunts, as the dissertation built it
  acyclic,      // by siblings and aunts, as it sketched it
  exhaustive,   // whatever the path rule allows: afterwards no node at all can go
};
struct RedundancyReport {
  Index by_siblings = 0, by_aunts = 0;  // found redundant, on all levels; not counted for exhaustive
  Index selected = 0;                   // of these, selected to go together
  Index vetoed = 0;                     // of the selected, kept because the path rule is not certain without them
  Index removed = 0;                    // nodes that are gone, with what was below and left empty above them
};

// Removes redundant nodes, from the top level down, the loosest of a level first: the one whose radius plus signed
// distance of the centre is largest. A removed node takes its subtree with it; a parent that loses its last child goes
// too. Precondition: the tree is conservative; it stays so.
RedundancyReport remove_redundant(SphereTree& tree, const Surface& surface, Selection selection = Selection::exhaustive,
                                  const Progress& progress = {});

}  // namespace orchard
