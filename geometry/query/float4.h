#pragma once
#include <cmath>
#include <limits>

// Arithmetic with four floats at once, and conversions to floats that keep bounds valid.

namespace orchard::detail {

// Four numbers, one for each child of a node or each triangle of a leaf (a GCC and Clang extension).
using Float4 = float __attribute__((vector_size(16)));

inline Float4 broadcast(float x) { return Float4{x, x, x, x}; }
inline Float4 min(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 abs(Float4 a) { return max(a, -a); }
inline Float4 square_root(Float4 a) {
  return Float4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
// Returns four dot products of three components each.
inline Float4 dot(const Float4* a, const Float4* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

// Return a float below x and a float above x, for every rounding mode of the conversion.
inline float rounded_down(double x) { return std::nextafter(static_cast<float>(x), -kFloatInfinity); }
inline float rounded_up(double x) { return std::nextafter(static_cast<float>(x), kFloatInfinity); }

}  // namespace orchard::detail
