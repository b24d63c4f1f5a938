#pragma once
#include <utility>
#include <vector>

#include "orchard/medial/thickness.h"
#include "slab_tree.h"

namespace orchard::detail {

// Finds the balls that touch a surface at given places. It is faster if each place is near the one before, because it
// starts at the triangle where the last ball ended. One object must not be used by several threads at once; they may
// share the tree.
class TangentBallSearch {
 public:
  TangentBallSearch(const Surface& surface, const SlabTree& tree, const ThicknessOptions& options)
      : surface_(surface), tree_(tree), options_(options) {}

  ThicknessAt at(const SurfacePlace& place);

 private:
  struct Entry {
    double bound;
    Index node;
    // The top of the heap is the entry with the smallest bound, and the smallest node among equal bounds.
    bool operator<(const Entry& other) const { return std::pair(bound, node) > std::pair(other.bound, other.node); }
  };
  // The state of one of the two searches of a place, with the triangle where the last one ended.
  struct Search {
    Index touched = kNone;
  };
  void try_normal(const SurfacePlace& place, const Vector& normal, ThicknessAt& best);
  double turn_around(Index triangle) const;
  void set_thickness(const TangentPlace& place, ThicknessAt& at);
  // Looks only for triangles that balls smaller than `limit` touch.
  void run(Search& search, const TangentPlace& place, double limit);
  void search(const TangentPlace& place);
  void descend(const TangentPlace& place, Index node);
  void slide(const TangentPlace& place);
  bool look_at(const TangentPlace& place, Index triangle);  // returns whether the triangle ends the ball
  double bound(const SlabTree::Node& node, const TangentPlace& place) const;

  const Surface& surface_;
  const SlabTree& tree_;
  const ThicknessOptions options_;
  std::vector<Index> around_;                     // the triangles that the place is on, ascending
  std::vector<std::pair<Index, Feature>> parts_;  // of them, and the part of each that the place is on
  Search first_, facing_;
  std::vector<Entry> waiting_;
  // Triangles whose normal has a larger component along the place's normal are skipped, because they do not face the
  // place.
  double max_cosine_ = 1;
  Touch found_;
  Index touched_ = kNone;  // the triangle that found_ lies on
  Index work_ = 0;
  double low_ = 0;  // a lower bound on the radius of a ball that touches
};

}  // namespace orchard::detail
