#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A k-d tree over points that finds the nearest one within a ball. Knows nothing of any diagram, so it can judge one.
class NearestPoint {
 public:
  explicit NearestPoint(std::span<const Point> points);

  // The squared distance from q to the nearest point, or the limit if no point is nearer than that.
  double squared_distance(const Point& q, double limit) const;

 private:
  struct Node {
    double split = 0;
    Index begin = 0, end = 0;  // of a leaf, into points_; an inner node's children follow at left and right
    Index right = kNone;       // kNone in a leaf; the left child comes right after its parent
    int axis = 0;
  };

  void build(Index begin, Index end);
  void search(Index node, const Point& q, Vector& offset, double& best) const;

  std::vector<Point> points_;
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
