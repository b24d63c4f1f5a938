#pragma once
#include <cmath>

#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// How far the image of a vector of length 1 moves at most when `before` turns and scales to `now`, translations aside,
// up to rounding and to what rotations may be off by.
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
