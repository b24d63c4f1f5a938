#pragma once
#include <utility>
#include <vector>

#include "orchard/medial/thickness.h"
#include "slab_tree.h"

namespace orchard::detail {

// Finds the balls that touch a surface at given places, faster if each is near the one before, where a ball is expected
// to end at the same triangle. Not for several threads at once; the tree may be shared.
class TangentBallSearch {
 public:
  TangentBallSearch(const Surface& surface, const SlabTree& tree, const ThicknessOptions& options)
      : surface_(surface), tree_(tree), options_(options) {}

  ThicknessAt at(const SurfacePlace& place);

 private:
  struct Entry {
    double bound;
    Index node;
    // The heap's top is the least bound, of equals the least node.
    bool operator<(const Entry& other) const { return std::pair(bound, node) > std::pair(other.bound, other.node); }
  };
  // One of the two searches of a place, and where the last one ended.
  struct Search {
    Index touched = kNone;
  };
  void try_normal(const SurfacePlace& place, const Vector& normal, ThicknessAt& best);
  double turn_around(Index triangle) const;
  void set_thickness(const TangentPlace& place, ThicknessAt& at);
  // Only what is touched by smaller balls than `limit` counts.
  void run(Search& search, const TangentPlace& place, double limit);
  void search(const TangentPlace& place);
  void descend(const TangentPlace& place, Index node);
  void slide(const TangentPlace& place);
  bool look_at(const TangentPlace& place, Index triangle);  // whether it ends the ball
  double bound(const SlabTree::Node& node, const TangentPlace& place) const;

  const Surface& surface_;
  const SlabTree& tree_;
  const ThicknessOptions options_;
  std::vector<Index> around_;                     // the triangles that the place is on, ascending
  std::vector<std::pair<Index, Feature>> parts_;  // of them, and the part of each that the place is on
  Search first_, facing_;
  std::vector<Entry> waiting_;
  // Triangles whose normal has a larger part along that of the place do not count: they do not face it.
  double max_cosine_ = 1;
  Touch found_;
  Index touched_ = kNone;  // the triangle that found_ is on
  Index work_ = 0;
  double low_ = 0;  // no ball that touches is smaller
};

}  // namespace orchard::detail
