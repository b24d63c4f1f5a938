#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// The connected components of a closed surface. A component with a negative volume bounds a cavity of a solid.
struct SolidParts {
  std::vector<Index> of_triangle;
  std::vector<double> volume;                      // signed, of each part
  std::vector<std::int64_t> euler_characteristic;  // 2 for a sphere
  Index count() const { return static_cast<Index>(volume.size()); }
  // Whether each component bounds a ball, so that there are no handles and no cavities.
  bool all_balls() const;
};

// Finds the components, numbered in the order of their first triangle. O(n).
SolidParts find_solid_parts(const Surface& surface);

}  // namespace orchard::detail
