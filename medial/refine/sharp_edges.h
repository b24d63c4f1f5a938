#pragma once
#include <vector>

#include "exact_ball.h"

namespace orchard::detail {

// The convex edges of a mesh whose faces turn by an angle or more. Not for several threads at once.
class SharpEdges {
 public:
  SharpEdges(const Surface& surface, double angle) : surface_(surface), angle_(angle) {}

  // The nearest place on them closer than `far`; false if there is none.
  bool nearest(const Point& place, double far, ClosestPoint& found);
  // The nearest of their ends.
  bool nearest_end(const Point& place, double far, ClosestPoint& found);

 private:
  template <class PlaceOnEdge>
  bool search(const Point& place, double far, ClosestPoint& found, PlaceOnEdge&& place_on_edge);

  const Surface& surface_;
  const double angle_;  // radians
  std::vector<Index> near_;
};

}  // namespace orchard::detail
