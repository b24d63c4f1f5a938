#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "predicates/predicates.h"
#include "predicates/twofold.h"
#include "predicates/vectors.h"

namespace orchard::detail {

namespace {

// Returns the difference of the powers of two points.
inline double sharp_power(const Point& center, const Point& p, const Point& q) {
  const auto product = [&](int axis) {
    return exact_difference(p[axis], q[axis]) *
           (exact_difference(center[axis], q[axis]) + exact_difference(center[axis], p[axis]));
  };
  return (product(0) + product(1) + product(2)).high;
}

// Where the centre is off by d, twice its product with the edge from p to q is the power of q less that of p, by the
// sphere around the centre: for d, three such differences are multiplied by the cross products of the other two edges
// each, over twice six times the volume. Of a needle two opposite edges are much shorter than the others; with these
// among the three, the differences are small, and so are their roundings. Six of these bound the error of a difference,
// in terms of the edge times the sum of two distances from the centre, the three make 36 with a radius; nine bound
// those of the cross products and the sum. What is left after a step is what these make, and what rounding does to the
// volume that it was divided by.
template <bool kSharp>
OffCenter off_center(const Point& center, const Point& q, const Point& p1, const Point& p2, const Point& p3) {
  Point a = p1, b = p2, c = p3;
  const Vector qa = a - q, qb = b - q, qc = c - q, ab = b - a, bc = c - b, ca = a - c;
  const double with_a = qa.squaredNorm() * bc.squaredNorm(), with_b = qb.squaredNorm() * ca.squaredNorm(),
               with_c = qc.squaredNorm() * ab.squaredNorm();
  if (with_b < with_a) std::swap(a, b);
  if (with_c < std::min(with_a, with_b)) std::swap(a, c);
  const Vector first = a - q, middle = b - q, last = c - b;
  const Vector from_q = center - q, from_a = center - a, from_b = center - b, from_c = center - c;
  const Vector power = kSharp
                           ? Vector(sharp_power(center, a, q), sharp_power(center, b, q), sharp_power(center, c, b))
                           : Vector(first.dot(from_q + from_a), middle.dot(from_q + from_b), last.dot(from_b + from_c));
  const double squared_radius = std::max(std::max(from_q.squaredNorm(), from_a.squaredNorm()),
                                         std::max(from_b.squaredNorm(), from_c.squaredNorm()));
  const double ff = first.squaredNorm(), mm = middle.squaredNorm(), ll = last.squaredNorm();
  const Vector sum = power.x() * middle.cross(last) + power.y() * last.cross(first) + power.z() * first.cross(middle);
  // at least the products of two lengths
  const Vector products(0.5 * (mm + ll), 0.5 * (ll + ff), 0.5 * (ff + mm));
  const double powers_error = (kSharp ? 3 * kSharper : 3) * std::sqrt(ff * mm * ll * squared_radius);
  const Determinant volume6 = volume(first, middle, last);
  const double divisor = 2 * (std::abs(volume6.value) - volume6.bound);
  const double length = sum.norm(), error = 16 * kRounding * (power.cwiseAbs().dot(products) + powers_error);
  const double of_volume = volume6.bound / std::abs(volume6.value) + 8 * kRounding;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  return {divisor > 0 ? (length + error) / divisor : kNone,
          divisor > 0 ? (error + length * of_volume) / divisor : kNone, sum * (0.5 / volume6.value)};
}

// A variant in which the fused operation is an instruction and not a call.
#ifdef ORCHARD_FOUR_LANES
[[gnu::target("fma"), gnu::flatten]] OffCenter fused_off_center(const Point& center, const Point& q, const Point& a,
                                                                const Point& b, const Point& c) {
  return off_center<true>(center, q, a, b, c);
}
const bool kFusedOffCenter = __builtin_cpu_supports("fma");
#else
OffCenter fused_off_center(const Point&, const Point&, const Point&, const Point&, const Point&) { return {}; }
constexpr bool kFusedOffCenter = false;
#endif

}  // namespace

OffCenter off_circumcenter(const Point& center, const Point& q, const Point& a, const Point& b, const Point& c) {
  return off_center<false>(center, q, a, b, c);
}

OffCenter sharply_off_circumcenter(const Point& center, const Point& q, const Point& a, const Point& b,
                                   const Point& c) {
  return kFusedOffCenter ? fused_off_center(center, q, a, b, c) : off_center<true>(center, q, a, b, c);
}

}  // namespace orchard::detail
