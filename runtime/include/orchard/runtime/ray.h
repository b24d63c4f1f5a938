#pragma once
#include <array>
#include <limits>

namespace orchard::runtime {

// The points origin + t direction, 0 <= t <= longest; direction of any length but 0.
struct Ray {
  std::array<double, 3> origin{}, direction{};
  double longest = std::numeric_limits<double>::infinity();
};

}  // namespace orchard::runtime
