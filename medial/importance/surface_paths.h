#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Finds short paths on a surface in a graph: the vertices of the divided mesh, joined along its edges and, where the
// straight line stays within both triangles of an edge, across them. In a mesh of equilateral triangles these are
// twelve directions, so a path is at most 1 / cos(15 degrees) = 1.035 times as long as the shortest one, but for its
// ends.
//
// The search for a path runs from one end and visits first what may lie on the shortest path to the other: from the
// distances of all vertices to a few landmarks, the triangle inequality bounds what is left of the way from below
// (Goldberg, Harrelson: Computing the shortest path: A* search meets graph theory, SODA 2005).
class SurfacePaths {
 public:
  // The graph for edges of at most `max_edge` (mesh units, above 0). O(n log n) for n vertices of the divided mesh.
  SurfacePaths(const Surface& surface, double max_edge);

  // The work space of one thread.
  class Search {
   public:
    explicit Search(std::size_t vertices) : lengths_(vertices), marks_(vertices, 0) {}

   private:
    friend class SurfacePaths;
    struct Entry {
      float at_least;  // the length of a path through the vertex
      float length;    // of the path to the vertex
      Index vertex;
      bool operator<(const Entry& other) const { return at_least > other.at_least; }  // the least on top of a heap
    };
    std::vector<float> lengths_;
    std::vector<std::uint32_t> marks_;  // of the run that a vertex's length is of
    std::uint32_t run_ = 0;
    std::vector<Entry> heap_;
  };
  Search search() const { return Search(mesh_.vertices.size()); }

  // The length in mesh units of a path between two places of the surface; infinite if no path joins them.
  double length(const ClosestPoint& from, const ClosestPoint& to, Search& search) const;

 private:
  struct Arc {
    Index to;
    float length;
  };
  // A place by the corners of its triangle and its distances to them.
  struct Place {
    Index triangle = kNone;
    Point position = Point::Zero();
    std::array<Index, 3> corners{};
    std::array<float, 3> lengths{};
  };

  void add_arcs();
  void add_landmarks();
  std::vector<float> distances_from(Index landmark) const;
  Place locate(const ClosestPoint& place) const;
  float at_least(Index vertex, const Place& to) const;

  TriangleMesh mesh_;
  std::vector<Index> of_triangle_;  // of the surface; ascending
  std::vector<Index> first_arc_;    // of each vertex, and the end
  std::vector<Arc> arcs_;
  std::size_t landmarks_ = 0;
  std::vector<float> to_landmarks_;  // of each vertex one after the other
};

}  // namespace orchard::detail
