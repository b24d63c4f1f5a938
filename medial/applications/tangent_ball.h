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
  // One of the two searches of a place.
  struct Search {
    bool may_miss;          // whether it may end with nothing found
    Index touched = kNone;  // the triangle where the last one ended
  };
  // The radii that a search is for. Triangles that only balls of radius `limit` or more touch are not looked for. The
  // search ends as soon as a ball is found that is no larger than `enough`.
  struct Radii {
    double limit, enough;
  };
  void try_normal(const SurfacePlace& place, const Vector& normal, ThicknessAt& best);
  double turn_around(Index triangle) const;
  void set_thickness(const SurfacePlace& place, ThicknessAt& at);
  void run(Search& search, const TangentPlace& place, const Radii& radii);
  void search(const TangentPlace& place, bool may_miss, double enough);
  void descend(const TangentPlace& place, Index node);
  void slide(const TangentPlace& place);
  bool look_at(const TangentPlace& place, Index triangle);  // returns whether the triangle ends the ball
  SlabTree::Lanes bounds(const SlabTree::Node& node, const TangentPlace& place) const;

  const Surface& surface_;
  const SlabTree& tree_;
  const ThicknessOptions options_;
  std::vector<Index> around_;                     // the triangles that the place is on, ascending
  std::vector<std::pair<Index, Feature>> parts_;  // of them, and the part of each that the place is on
  Search first_{.may_miss = false}, facing_{.may_miss = true};
  Index ended_ = kNone;            // the triangle that ends the largest ball of the place so far
  std::vector<Index> around_end_;  // the triangles that this ball touches there
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
