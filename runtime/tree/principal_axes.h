#pragma once
#include <array>

#include "pair/triangle_pair.h"

namespace orchard::runtime::detail {

inline Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Eigenvectors of a symmetric matrix {xx, yy, zz, xy, xz, yz} by Jacobi rotations, the largest eigenvalue's first.
std::array<Vec3, 3> axes_of(const std::array<double, 6>& matrix) noexcept;

}  // namespace orchard::runtime::detail
