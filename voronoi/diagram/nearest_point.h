#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Finds the nearest point within a ball by a tree of boxes. It uses no diagram, so it can serve to check one. The boxes
// are tight and turned along the principal axes of their points: a ball that only touches the surface on which the
// points lie misses nearly all of these boxes, whereas it would cut many upright boxes.
class NearestPoint {
 public:
  explicit NearestPoint(std::span<const Point> points);

  // The squared distance from q to the nearest point, or the limit if no point is nearer than that.
  double squared_distance(const Point& q, double limit) const;

  // Stores the points within the ball in `found`. Returns false if there are more than `max`; some are then missing.
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
