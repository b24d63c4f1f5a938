#pragma once
#include <array>
#include <vector>

#include "../balls/exact_ball.h"
#include "feature_edges.h"

namespace orchard::detail {

// Looks for places on the feature edges of a mesh. Not for several threads at once.
class SharpEdges {
 public:
  SharpEdges(const Surface& surface, const FeatureEdges& features) : surface_(surface), features_(features) {}

  // The nearest place on them closer than `far`; false if there is none.
  bool nearest(const Point& place, double far, ClosestPoint& found);
  // Whether two places on them are on one, or on such as turn little between them.
  bool goes_between(const Point& a, const Point& b);
  // All that come within `far`, as pairs of ascending vertices. Cleared first.
  void all_at(const Point& place, double far, std::vector<std::array<Index, 2>>& found);
  // The nearest of their ends.
  bool nearest_end(const Point& place, double far, ClosestPoint& found);

 private:
  // Calls visit(triangle, side) for each with a triangle within `far` of a place.
  template <class Visit>
  void visit_near(const Point& place, double far, const Visit& visit);
  template <class PlaceOnEdge>
  bool search(const Point& place, double far, ClosestPoint& found, PlaceOnEdge&& place_on_edge);

  const Surface& surface_;
  const FeatureEdges& features_;
  std::vector<Index> near_;
};

}  // namespace orchard::detail
