#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Collects faces of three or more corners as triangles. Corners may refer to vertices that are not known yet, because
// polygons are divided in finish().
class FaceCollector {
 public:
  // `at` is the byte of the face in the file. Precondition: at least three corners. Throws InputError if there are too
  // many triangles for 32-bit indices.
  void add(std::span<const Index> corners, std::size_t at = 0);
  bool empty() const { return triangles_.empty(); }
  // Returns triangles that together name every corner of every face.
  std::span<const std::array<Index, 3>> corners() const { return triangles_; }

  struct Split {
    std::vector<std::array<Index, 3>> triangles;
    Index triangulated = 0;             // polygons that no fan of triangles fills
    Index overlapping = 0;              // polygons that nothing fills without overlap; they become fans
    std::size_t first_overlapping = 0;  // the byte of the first of these
  };
  // Divides each polygon into the fan of triangles around one of its corners that agrees best with the polygon's
  // normal; the first corner is taken unless another is clearly better. If no fan that is tried fills it (at most
  // kTrials corners are tried), the polygon is triangulated instead, without corners that repeat the previous one. O(n
  // log n). Precondition: corners < vertices.size(), and all vertices are finite.
  Split finish(std::span<const Point> vertices) &&;

 private:
  static constexpr std::size_t kTrials = 64;
  struct Face {
    std::size_t first_triangle;
    Index corners;
    std::size_t at;
  };
  std::vector<std::array<Index, 3>> triangles_;  // polygons as fans around corner 0
  std::vector<Face> faces_;                      // faces with four or more corners
};

// Returns a constrained Delaunay triangulation (by CGAL) of a polygon in its best plane, which is that of Newell's
// normal. Corners may repeat, as in a polygon that goes around a hole along a bridge. Triangles have the orientation of
// the polygon. If a corner lies on an edge, a triangle without area keeps the edge whole. Returns nullopt if the
// outline crosses itself or encloses a place twice. Precondition: the normal has length 1. See
// polygon_triangulation_cgal.cpp.
std::optional<std::vector<std::array<Index, 3>>> triangulate_polygon(std::span<const Index> corners,
                                                                     std::span<const Point> vertices,
                                                                     const Vector& normal);

}  // namespace orchard
