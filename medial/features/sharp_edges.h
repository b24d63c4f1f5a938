#pragma once
#include <array>
#include <vector>

#include "../balls/exact_ball.h"
#include "feature_edges.h"

namespace orchard::detail {

// Finds places on the feature edges of a mesh. An object must not be used by several threads at once.
class SharpEdges {
 public:
  SharpEdges(const Surface& surface, const FeatureEdges& features) : surface_(surface), features_(features) {}

  // Finds the nearest place on the feature edges, if one is closer than `far`. Returns whether there is one.
  bool nearest(const Point& place, double far, ClosestPoint& found);
  // Whether two places on feature edges are on the same edge, or on edges that turn little between the two.
  bool goes_between(const Point& a, const Point& b);
  // Finds all feature edges that come within `far`, as pairs of ascending vertices. `found` is cleared first.
  void all_at(const Point& place, double far, std::vector<std::array<Index, 2>>& found);
  // Finds the nearest end of a feature edge, like nearest().
  bool nearest_end(const Point& place, double far, ClosestPoint& found);

 private:
  // Calls visit(triangle, side) for each feature edge that has a triangle within `far` of the place.
  template <class Visit>
  void visit_near(const Point& place, double far, const Visit& visit);
  template <class PlaceOnEdge>
  bool search(const Point& place, double far, ClosestPoint& found, PlaceOnEdge&& place_on_edge);

  const Surface& surface_;
  const FeatureEdges& features_;
  std::vector<Index> near_;
};

}  // namespace orchard::detail
