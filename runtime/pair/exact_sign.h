#pragma once
#include <array>

// Signs of determinants of double coordinates. Exact if these are multiples of 2^-357, as all are that are 0 or at
// least 2^-305, and at most 1e100: no product of three differences, and no part of one, then underflows or overflows.
// The usual case costs one evaluation in double; close ones are repeated with twice the digits, ties in full.
namespace orchard::runtime::detail {

using Vec3 = std::array<double, 3>;

// > 0 if a, b, c appear counterclockwise when seen from the side of their plane away from d, 0 if all four are
// coplanar.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// The same in the plane that remains when `axis` is dropped: > 0 if a, b, c turn counterclockwise, 0 if collinear.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t axis) noexcept;

}  // namespace orchard::runtime::detail
