#pragma once
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Exact integers, for determinants whose sign lower precision cannot decide: doubles as whole multiples of a power of
// two. They need no allocation, and short numbers are fast: a determinant of points of a grid takes only a few words.
// Points in a Frame have coordinates below 4 that are multiples of 2^-200, so products of degree five fit.
constexpr unsigned kExactBits = 1088;
using ExactInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<kExactBits, kExactBits, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;

// A finite double in the form mantissa * 2^exponent.
struct Binary {
  std::int64_t mantissa;
  int exponent;

  explicit Binary(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const auto biased = static_cast<int>((bits >> 52) & 0x7ff);
    mantissa = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << 52) - 1));
    if (biased != 0) mantissa |= std::int64_t{1} << 52;
    exponent = (biased != 0 ? biased : 1) - 1075;
    if (x < 0) mantissa = -mantissa;
  }
};

// Returns the largest exponent such that all coordinates of the points are multiples of that power of two.
inline int common_unit(std::initializer_list<const Point*> points) {
  int unit = std::numeric_limits<int>::max();
  for (const Point* point : points)
    for (const double x : {point->x(), point->y(), point->z()}) {
      const Binary binary(x);
      if (binary.mantissa == 0) continue;
      unit = std::min(unit, binary.exponent + std::countr_zero(static_cast<std::uint64_t>(binary.mantissa)));
    }
  return unit;
}

// Returns x / 2^unit. Precondition: this is a whole number of at most about 200 bits.
inline ExactInteger in_units(double x, int unit) {
  const Binary binary(x);
  if (binary.mantissa == 0) return 0;
  const int shift = binary.exponent - unit;
  assert(shift < 210);
  return shift < 0 ? ExactInteger(binary.mantissa >> -shift) : ExactInteger(binary.mantissa) << shift;
}

// Returns numerator / denominator * 2^unit, up to a few roundings; infinity if it is too large for a double.
inline double quotient(const ExactInteger& numerator, const ExactInteger& denominator, int unit) {
  if (numerator == 0) return 0;
  // Uses the leading 64 bits of both, so that neither overflows.
  const auto leading = [](const ExactInteger& number, int& exponent) {
    const ExactInteger magnitude = abs(number);
    const auto top = static_cast<int>(msb(magnitude));
    exponent = top > 63 ? top - 63 : 0;
    const auto bits = static_cast<double>(static_cast<std::uint64_t>(magnitude >> exponent));
    return number < 0 ? -bits : bits;
  };
  int up = 0, down = 0;
  const double high = leading(numerator, up), low = leading(denominator, down);
  return std::ldexp(high / low, up - down + unit);
}

}  // namespace orchard::detail
