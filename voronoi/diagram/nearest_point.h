#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A tree of boxes around points that finds the nearest one within a ball. Knows nothing of any diagram, so it can judge
// one. The boxes are tight and turned along the points' principal axes: a ball that only touches the surface that the
// points are on misses nearly all of them, where upright boxes would stick out by their width.
class NearestPoint {
 public:
  explicit NearestPoint(std::span<const Point> points);

  // The squared distance from q to the nearest point, or the limit if no point is nearer than that.
  double squared_distance(const Point& q, double limit) const;

  // The points within the ball go to `found`; false if these are more than `max`: then they are not all there.
  bool within(const Point& q, double squared_radius, std::size_t max, std::vector<Point>& found) const;

 private:
  struct Node {
    Eigen::Matrix3d axes;      // rows
    Box box;                   // along the axes
    Index begin = 0, end = 0;  // into points_
    Index right = kNone;       // the second child, kNone in a leaf; the first comes right after its parent
  };

  void build(Index begin, Index end);
  double squared_distance_bound(Index node, const Point& q) const;
  void search(Index node, const Point& q, double& best) const;
  void collect(Index node, const Point& q, double squared_radius, std::size_t max, std::vector<Point>& found) const;

  std::vector<Point> points_;
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
