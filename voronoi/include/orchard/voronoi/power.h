#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// The power diagram of balls, clipped by a box.
namespace orchard {

// The power diagram of balls: each place belongs to the ball with the smallest |p - c|^2 - r^2. The cells contain the
// places within a box; parts far outside it are cut off.
struct PowerDiagram {
  struct Vertex {
    std::array<Index, 4> balls;  // Ascending, as in edges and facets.
    Point position;
  };
  struct Edge {
    std::array<Index, 3> balls;
    std::array<Point, 2> ends;
  };
  struct Facet {
    std::array<Index, 2> balls;
    // The corners in order around the facet, which is flat and convex up to rounding.
    std::vector<Point> corners;
  };
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  std::vector<Facet> facets;
  std::vector<std::uint8_t> holds_center;  // For each ball, whether its centre is in its own cell.
};

// Builds the power diagram of balls by CGAL's regular triangulation with exact predicates; positions are rounded. The
// items are in ascending order of their balls. If five balls or more meet in one place, the diagram is that of a
// perturbation, with edges and facets of size zero. Precondition: centres and radii are finite. O(n log n) in practice.
PowerDiagram power_diagram(std::span<const Sphere> balls, const Box& box);

}  // namespace orchard
