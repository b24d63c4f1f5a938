#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

// Removes spheres that a tree does not need (dissertation 5.3.4). All functions require a tree that is conservative by
// the path rule, whole or cut off below any level. Removal keeps it conservative: a sphere stays unless the boundary
// lemma proves that it can be removed.
namespace orchard {

// A node that covers no part of the surface that its coverers do not cover. This is the dissertation's definition: it
// compares balls with balls and ignores the balls above and below them.
struct RedundantNode {
  Index node = kNone;
  // The nodes that the covering depends on, ascending.
  std::vector<Index> coverers;
};
// The nodes that may cover a redundant node: its siblings or the siblings of its parent.
enum class Coverers { siblings, aunts };
// Returns the redundant nodes of one level, ascending. The work is parallel over nodes.
std::vector<RedundantNode> redundant_nodes(const SphereTree& tree, const Surface& surface, Index level, Coverers by);

// Selects redundant nodes that may be removed together. An independent selection contains no node that another one of
// the selection depends on; it is greedy, in order of increasing degree. In an acyclic selection, a removed node may
// depend on another removed node if the chain ends in nodes that stay; of each cycle, the node that most others depend
// on is kept.
std::vector<Index> independent_selection(std::span<const RedundantNode> redundant);
std::vector<Index> acyclic_selection(std::span<const RedundantNode> redundant);

// Which redundant spheres remove_redundant() removes.
enum class Selection {
  // By siblings and aunts, as the dissertation implemented it.
  independent,
  // By siblings and aunts, as the dissertation sketched it.
  acyclic,
  // All spheres that the path rule allows to remove: afterwards no further node can be removed.
  exhaustive,
};
// Counts of remove_redundant().
struct RedundancyReport {
  // Nodes found redundant on all levels; not counted for `exhaustive`.
  Index by_siblings = 0, by_aunts = 0;
  Index selected = 0;  // Of these, the nodes selected for removal together.
  // Of the selected nodes, those kept because the path rule is not certain without them.
  Index vetoed = 0;
  // The nodes removed, including those below them and parents that lost their last child.
  Index removed = 0;
};

// Removes redundant nodes from the top level down, the loosest of a level first, which is the one with the largest sum
// of radius and signed distance of the centre. A node is removed with its subtree, and a parent that loses its last
// child is removed, too. Precondition: the tree is conservative; it remains so.
RedundancyReport remove_redundant(SphereTree& tree, const Surface& surface, Selection selection = Selection::exhaustive,
                                  const Progress& progress = {});

}  // namespace orchard
