#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "exact_sign.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

struct Support {
  double most;  // at least direction . point for every point, but for rounding of a few 1e-16 of the coordinates
  Vec3 point;   // where about
};

// How far a body reaches along any direction, from PackedSphereTree::supports: the support function of a set is convex
// and homogeneous, so between the four directions around a given one it lies below their interpolation. Some 1 % too
// far.
inline Support support_along(std::span<const float> map, const Vec3& u) noexcept {
  constexpr std::size_t side = kSupportCells + 1;
  const double x = std::fabs(u[0]), y = std::fabs(u[1]), z = std::fabs(u[2]);
  const std::size_t axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  const std::size_t next = axis == 2 ? 0 : axis + 1, last = axis == 0 ? 2 : axis - 1;
  const double size = std::fabs(u[axis]), sign = u[axis] < 0 ? -1 : 1;
  if (!(size > 0)) return {0, {}};
  const double shrink = 1 / size;
  const double slow = std::clamp(u[next] * shrink, -1.0, 1.0), fast = std::clamp(u[last] * shrink, -1.0, 1.0);
  const auto cell = [](double t) {
    return std::min<std::size_t>(static_cast<std::size_t>((t + 1) * (kSupportCells / 2)), kSupportCells - 1);
  };
  const std::size_t i = cell(slow), j = cell(fast);
  const double f = (slow + 1) * (kSupportCells / 2) - static_cast<double>(i);
  const double g = (fast + 1) * (kSupportCells / 2) - static_cast<double>(j);
  const float* const at = &map[((2 * axis + (sign < 0)) * side + i) * side + j];
  const double a = double{at[0]}, b = double{at[side]}, c = double{at[1]}, d = double{at[side + 1]};
  const double low = a + f * (b - a), high = c + f * (d - c), value = low + g * (high - low);
  const double by_slow = ((b - a) + g * ((d - c) - (b - a))) * (kSupportCells / 2);
  const double by_fast = (high - low) * (kSupportCells / 2);
  Support support{value * size, {}};
  support.point[axis] = sign * (value - slow * by_slow - fast * by_fast);
  support.point[next] = by_slow, support.point[last] = by_fast;
  return support;
}

}  // namespace orchard::runtime::detail
