#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "math/exact_sign.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

// How far a body reaches along a direction.
struct Support {
  double most;  // an upper bound on direction . point over all points, up to rounding by a few 1e-16 of the coordinates
  Vec3 point;   // the approximate point that reaches so far
};

inline constexpr double kHalfSupportCells = 0.5 * kSupportCells;

// Where a direction, which is not zero, leaves the cube of directions: a cell of a face, and a place in this cell.
struct SupportCell {
  std::size_t axis, next, last;  // `axis` is that of the face; the others are the remaining ones
  double size, slow, fast;       // |component along `axis`|, and the components along `next` and `last` divided by it
  double f, g;                   // the place in the cell, from 0 to 1
  const float* corner;           // the table's value at the first corner of the cell
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

// Returns how far a body reaches along a direction, which is not zero, from PackedSphereTree::supports, and the point
// that does. The support function of a set is convex and homogeneous, so it lies below the interpolation between the
// four directions around the given one. The gradient of that is the point. The result is about 1 % too far.
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
