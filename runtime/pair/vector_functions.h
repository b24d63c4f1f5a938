#pragma once
#include "exact_sign.h"

// The few operations that exact tests, distances and the builder of triangle trees need on plain arrays.
namespace orchard::runtime::detail {

inline Vec3 minus(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// a + t d.
inline Vec3 along(const Vec3& a, const Vec3& d, double t) noexcept {
  return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}

}  // namespace orchard::runtime::detail
