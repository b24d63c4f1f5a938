#pragma once
#include <cmath>

namespace orchard::detail {

// An unevaluated sum of two doubles, the second below half a unit in the last place of the first: about 106 bits.
struct Twofold {
  double high = 0, low = 0;

  Twofold() = default;
  Twofold(double value) : high(value) {}
  Twofold(double h, double l) : high(h), low(l) {}
};

// A formula has a few dozen operations with a relative error of 2^-104 each, in terms of the error bound of the same
// formula in doubles.
inline constexpr double kSharper = 0x1p-48;

// The divisor has to be this many times its error, so that the quotient is right to a few rounding errors of a double.
inline constexpr double kDivisible = 0x1p46;

// The exact sum (Knuth), difference, and product (Dekker, by the fused operation) of two doubles.
inline Twofold exact_sum(double a, double b) {
  const double sum = a + b, b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}
inline Twofold exact_difference(double a, double b) { return exact_sum(a, -b); }
inline Twofold exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

// The same sum in half the time. b has to be the smaller number, or too small to matter beyond half of a double's
// precision.
inline Twofold quick_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

// The errors of sums and differences are a few 2^-106 times the sum of the absolute values, not of the result. That
// suffices for determinants, which are compared with the sum of their absolute products.
inline Twofold operator-(const Twofold& a) { return {-a.high, -a.low}; }
inline Twofold operator+(const Twofold& a, const Twofold& b) {
  const Twofold high = exact_sum(a.high, b.high);
  return quick_sum(high.high, high.low + (a.low + b.low));
}
inline Twofold operator-(const Twofold& a, const Twofold& b) { return a + -b; }
inline Twofold operator*(const Twofold& a, const Twofold& b) {
  const Twofold p = exact_product(a.high, b.high);
  return quick_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}
inline Twofold operator/(const Twofold& a, const Twofold& b) {
  const double first = a.high / b.high;
  const Twofold rest = a - b * Twofold(first);
  return exact_sum(first, rest.high / b.high);
}

}  // namespace orchard::detail
