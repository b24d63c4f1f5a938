#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Finds the nearest of some points by a tree that halves them along the longest side of each box.
class NearestSample {
 public:
  explicit NearestSample(std::vector<Point> points);

  // Calls visit(index) for points within a distance of the query. The distance is `limit` at first, and then whatever
  // visit() returned last. Nearer points tend to come first.
  template <class Visit>
  void visit(const Point& query, double limit, const Visit& visit) const {
    if (!points_.empty()) descend(0, static_cast<Index>(points_.size()), query, limit, visit);
  }
  const Point& operator[](Index i) const { return points_[i]; }

 private:
  static constexpr Index kLeaf = 8;  // as few points are not divided any more
  struct Split {
    int axis = 0;
    double at = 0;
  };
  void divide(Index begin, Index end);

  template <class Visit>
  void descend(Index begin, Index end, const Point& query, double& limit, const Visit& visit) const {
    if (end - begin <= kLeaf) {
      for (Index i = begin; i < end; ++i)
        if ((points_[order_[i]] - query).squaredNorm() <= limit * limit) limit = visit(order_[i]);
      return;
    }
    const Index middle = begin + (end - begin) / 2;
    const Split& split = splits_[middle];
    const double offset = query[split.axis] - split.at;
    const bool low_first = offset < 0;
    low_first ? descend(begin, middle, query, limit, visit) : descend(middle, end, query, limit, visit);
    if (offset * offset > limit * limit) return;
    low_first ? descend(middle, end, query, limit, visit) : descend(begin, middle, query, limit, visit);
  }

  std::vector<Point> points_;
  std::vector<Index> order_;
  std::vector<Split> splits_;  // the split of each range is stored at its middle
};

}  // namespace orchard::detail
