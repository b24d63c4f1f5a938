#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Collects faces of three corners or more as triangles. Corners may name vertices that are not known yet: polygons are
// split for good by finish().
class FaceCollector {
 public:
  // Precondition: at least three corners. Throws InputError if the triangles become too many for 32-bit indices.
  void add(std::span<const Index> corners);
  bool empty() const { return triangles_.empty(); }
  // Each polygon becomes the fan of triangles, around one of its corners, that agrees best with the polygon's normal;
  // the first corner wins unless another is clearly better. Linear in the number of corners: polygons of more than
  // kTrials corners try that many of them. Precondition: corners < vertices.size().
  std::vector<std::array<Index, 3>> finish(std::span<const Point> vertices) &&;

 private:
  static constexpr std::size_t kTrials = 64;
  struct Face {
    std::size_t first_triangle;
    Index corners;
  };
  std::vector<std::array<Index, 3>> triangles_;  // polygons: the fan around corner 0
  std::vector<Face> faces_;                      // of four corners or more
};

}  // namespace orchard
