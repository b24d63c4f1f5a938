#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Collects faces of three corners or more as triangles. Corners may name vertices that are not known yet: finish()
// splits the polygons.
class FaceCollector {
 public:
  // `at`: byte of the file where the face is. Precondition: at least three corners. Throws InputError if the triangles
  // become too many for 32-bit indices.
  void add(std::span<const Index> corners, std::size_t at = 0);
  bool empty() const { return triangles_.empty(); }
  // Triangles between them that name every corner of every face.
  std::span<const std::array<Index, 3>> corners() const { return triangles_; }

  struct Split {
    std::vector<std::array<Index, 3>> triangles;
    Index triangulated = 0;             // polygons that no fan fills
    Index overlapping = 0;              // polygons that nothing fills without overlap: they are fans all the same
    std::size_t first_overlapping = 0;  // the byte of the first of those
  };
  // Each polygon becomes the fan of triangles, around one of its corners, that agrees best with the polygon's normal;
  // the first corner wins unless another is clearly better. Where no fan of those tried fills it (polygons of more than
  // kTrials corners try that many), it is triangulated instead. A corner that repeats the one before it is left out
  // there. O(n log n). Precondition: corners < vertices.size(), all of these finite.
  Split finish(std::span<const Point> vertices) &&;

 private:
  static constexpr std::size_t kTrials = 64;
  struct Face {
    std::size_t first_triangle;
    Index corners;
    std::size_t at;
  };
  std::vector<std::array<Index, 3>> triangles_;  // polygons: the fan around corner 0
  std::vector<Face> faces_;                      // of four corners or more
};

// A constrained Delaunay triangulation of a polygon in its best plane, which Newell's normal names (CGAL). Corners may
// repeat, as those of a polygon that goes around a hole along a bridge do. Triangles turn as the polygon does; where a
// corner lies on an edge, one without area keeps the edge whole. Nothing if the outline crosses itself or encloses a
// place twice. polygon_triangulation_cgal.cpp. Precondition: the normal has length 1.
std::optional<std::vector<std::array<Index, 3>>> triangulate_polygon(std::span<const Index> corners,
                                                                     std::span<const Point> vertices,
                                                                     const Vector& normal);

}  // namespace orchard
