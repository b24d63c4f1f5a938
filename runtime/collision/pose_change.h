#pragma once
#include <cmath>

#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// Returns a bound on how far the image of a vector of length 1 moves from `before` to `now`, without the translations.
// It holds up to rounding and to the error that rotations may have.
inline double pose_change(const Pose& before, const Pose& now) noexcept {
  double square = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const double change = now.scale * now.rotation[i] - before.scale * before.rotation[i];
    square += change * change;
  }
  // Two rotations differ by an angle about an axis, so that a vector changes by at most 1 / sqrt(2) of that norm.
  return std::sqrt(now.scale == before.scale ? square / 2 : square);
}

}  // namespace orchard::runtime::detail
