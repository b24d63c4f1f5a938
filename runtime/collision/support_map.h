#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "math/exact_sign.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

struct Support {
  double most;  // at least direction . point for every point, but for rounding of a few 1e-16 of the coordinates
  Vec3 point;   // where about
};

inline constexpr double kHalfSupportCells = 0.5 * kSupportCells;

// Where a direction, not zero, leaves the cube of directions: an axis, its sign, a cell of that face and a place in it.
struct SupportCell {
  std::size_t axis, next, last;
  double size, slow, fast;  // of the component along the axis; the two others divided by it
  double f, g;              // in the cell, from 0 to 1
  const float* corner;      // the cell's first one
};

inline SupportCell support_cell(std::span<const float> map, const Vec3& u) noexcept {
  constexpr std::size_t side = kSupportCells + 1;
  const double x = std::fabs(u[0]), y = std::fabs(u[1]), z = std::fabs(u[2]);
  SupportCell c{};
  c.axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  c.next = c.axis == 2 ? 0 : c.axis + 1, c.last = c.axis == 0 ? 2 : c.axis - 1;
  c.size = std::fabs(u[c.axis]);
  c.slow = u[c.next] / c.size, c.fast = u[c.last] / c.size;  // from -1 to 1, rounding included
  c.f = (c.slow + 1) * kHalfSupportCells, c.g = (c.fast + 1) * kHalfSupportCells;
  const int i = std::min(static_cast<int>(c.f), static_cast<int>(kSupportCells) - 1);
  const int j = std::min(static_cast<int>(c.g), static_cast<int>(kSupportCells) - 1);
  c.f -= i, c.g -= j;
  const std::size_t face = 2 * c.axis + (u[c.axis] < 0);
  c.corner = map.data() + (face * side + static_cast<std::size_t>(i)) * side + static_cast<std::size_t>(j);
  return c;
}

// How far a body reaches along a direction, not zero, from PackedSphereTree::supports, and the point that does: the
// support function of a set is convex and homogeneous, so between the four directions around a given one it lies below
// their interpolation, whose gradient is the point. Some 1 % too far.
inline Support support_along(std::span<const float> map, const Vec3& u) noexcept {
  const SupportCell cell = support_cell(map, u);
  const float* const at = cell.corner;
  const double a = double{at[0]}, b = double{at[kSupportCells + 1]}, c = double{at[1]},
               d = double{at[kSupportCells + 2]};
  const double low = a + cell.f * (b - a), high = c + cell.f * (d - c), value = low + cell.g * (high - low);
  const double by_slow = ((b - a) + cell.g * ((d - c) - (b - a))) * kHalfSupportCells;
  const double by_fast = (high - low) * kHalfSupportCells;
  Support support{value * cell.size, {}};
  support.point[cell.axis] = (u[cell.axis] < 0 ? -1 : 1) * (value - cell.slow * by_slow - cell.fast * by_fast);
  support.point[cell.next] = by_slow, support.point[cell.last] = by_fast;
  return support;
}
inline double reach_along(std::span<const float> map, const Vec3& u) noexcept { return support_along(map, u).most; }

}  // namespace orchard::runtime::detail
