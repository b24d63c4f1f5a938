#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// The power diagram of balls: each place belongs to the ball of the least |p - c|^2 - r^2. Cells are those of places
// within a box; what lies far outside of it is cut off.
struct PowerDiagram {
  struct Vertex {
    std::array<Index, 4> balls;  // ascending; so below
    Point position;
  };
  struct Edge {
    std::array<Index, 3> balls;
    std::array<Point, 2> ends;
  };
  struct Facet {
    std::array<Index, 2> balls;
    std::vector<Point> corners;  // in their order around it; flat and convex up to rounding
  };
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  std::vector<Facet> facets;
  std::vector<std::uint8_t> holds_center;  // of each ball: whether its centre is in its own cell
};

// By CGAL's regular triangulation, with exact predicates; positions are rounded. Items are in ascending order of their
// balls. O(n log n) in practice. Precondition: centres and radii are finite. Where five balls or more meet in one
// place, the diagram is one that a perturbation gives, with edges and facets of no size.
PowerDiagram power_diagram(std::span<const Sphere> balls, const Box& box);

}  // namespace orchard
