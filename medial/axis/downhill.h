#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// The way over a surface downhill on the distance from a point. Not for several threads at once.
class Downhill {
 public:
  explicit Downhill(const Surface& surface) : surface_(surface) {}

  // From `place`, which is on the surface, to where the distance from `from` has a local minimum.
  ClosestPoint descend(const Point& from, ClosestPoint place);

 private:
  const Surface& surface_;
  std::vector<Index> around_, measured_;  // of a step, and of the one before
};

}  // namespace orchard::detail
