#include <array>
#include <cmath>
#include <limits>

#include "predicates.h"
#include "twofold.h"

namespace orchard::detail {
namespace {

// The powers of a, b and c with respect to the sphere around the centre through q: a . (2 centre - a) and so on, all
// relative to q. Twofold, but for what rounding leaves beyond; the same for all points in loops without branches, for
// compilers to do at once.
inline Vector sharp_powers(const Point& center, const Point& q, const Point& a, const Point& b, const Point& c) {
  constexpr unsigned kLanes = 4, kCenter = 3;
  std::array<double, kLanes> high{}, low{};
  for (unsigned k = 0; k < 3; ++k) {
    const std::array<double, kLanes> point{a[k], b[k], c[k], center[k]};
    std::array<Twofold, kLanes> from_q;
    for (unsigned i = 0; i < kLanes; ++i) from_q[i] = exact_difference(point[i], q[k]);
    const double twice = 2 * from_q[kCenter].high, twice_low = 2 * from_q[kCenter].low;
    for (unsigned i = 0; i < kLanes; ++i) {
      const Twofold rest = exact_difference(twice, from_q[i].high);
      const double rest_low = rest.low + (twice_low - from_q[i].low);
      const Twofold product = exact_product(from_q[i].high, rest.high), sum = exact_sum(high[i], product.high);
      high[i] = sum.high;
      low[i] += (sum.low + product.low) + (from_q[i].high * rest_low + from_q[i].low * rest.high);
    }
  }
  return {high[0] + low[0], high[1] + low[1], high[2] + low[2]};
}

#if defined(__GNUC__) && defined(__x86_64__)
[[gnu::target("avx2,fma"), gnu::flatten]] Vector fused_powers(const Point& center, const Point& q, const Point& a,
                                                              const Point& b, const Point& c) {
  return sharp_powers(center, q, a, b, c);
}
const bool kFusedLanes = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
Vector fused_powers(const Point&, const Point&, const Point&, const Point&, const Point&) { return Vector::Zero(); }
constexpr bool kFusedLanes = false;
#endif

}  // namespace

// Where the centre is off by d, 2 a . d is the power of a; so d is the sum of the three powers times the cross products
// of the other two, over twice six times the volume. 16 roundings bound the errors of the cross products and the sum,
// and those of the powers in doubles.
double off_circumcenter(const Point& center, const Point& q, const Point& a, const Point& b, const Point& c,
                        const Determinant& volume6, double enough) {
  if (volume6.sign() == Sign::uncertain) return std::numeric_limits<double>::infinity();
  const Vector qa = a - q, qb = b - q, qc = c - q, twice = 2 * (center - q);
  const Vector bc = qb.cross(qc), ca = qc.cross(qa), ab = qa.cross(qb);
  const double aa = qa.squaredNorm(), bb = qb.squaredNorm(), cc = qc.squaredNorm();
  // No less than |b||c| and so on, and than the sum of |a||b||c|(|twice| + |a|) and so on.
  const Vector products = 0.5 * Vector(bb + cc, cc + aa, aa + bb);
  const double powers_error = std::sqrt(aa * bb * cc) * (3 * twice.norm() + std::sqrt(3 * (aa + bb + cc)));
  const double divisor = 2 * (std::abs(volume6.value) - volume6.bound);
  const auto bound = [&](const Vector& power, double sharpness) {
    const Vector sum = power.x() * bc + power.y() * ca + power.z() * ab;
    return (sum.norm() + 16 * kRounding * (power.cwiseAbs().dot(products) + sharpness * powers_error)) / divisor;
  };
  if (16 * kRounding * powers_error < enough * divisor) {
    const double fast = bound({qa.dot(twice - qa), qb.dot(twice - qb), qc.dot(twice - qc)}, 1);
    if (fast <= enough) return fast;
  }
  return bound(kFusedLanes ? fused_powers(center, q, a, b, c) : sharp_powers(center, q, a, b, c), kSharper);
}

}  // namespace orchard::detail
