#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Walks over a surface downhill on the distance from a point. An object must not be used by several threads at once.
class Downhill {
 public:
  explicit Downhill(const Surface& surface) : surface_(surface) {}

  // Walks from `place`, which is on the surface, to a local minimum of the distance from `from`.
  ClosestPoint descend(const Point& from, ClosestPoint place);

 private:
  const Surface& surface_;
  std::vector<Index> around_, measured_;  // the triangles of this step and of the last one
};

}  // namespace orchard::detail
