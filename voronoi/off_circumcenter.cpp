#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "predicates.h"

namespace orchard::detail {

// Where the centre is off by d, twice its product with the edge from p to q is the power of q less that of p, by the
// sphere around the centre: for d, three such differences are multiplied by the cross products of the other two edges
// each, over twice six times the volume. Of a needle two opposite edges are much shorter than the others; with these
// among the three, the differences are small, and so are their roundings. Six of these bound the error of a difference,
// in terms of the edge times the sum of two distances from the centre, the three make 36 with a radius; nine bound
// those of the cross products and the sum.
double off_circumcenter(const Point& center, const Point& q, const Point& p1, const Point& p2, const Point& p3) {
  Point a = p1, b = p2, c = p3;
  const Vector qa = a - q, qb = b - q, qc = c - q, ab = b - a, bc = c - b, ca = a - c;
  const double with_a = qa.squaredNorm() * bc.squaredNorm(), with_b = qb.squaredNorm() * ca.squaredNorm(),
               with_c = qc.squaredNorm() * ab.squaredNorm();
  if (with_b < with_a) std::swap(a, b);
  if (with_c < std::min(with_a, with_b)) std::swap(a, c);
  const Vector first = a - q, middle = b - q, last = c - b;
  const Vector from_q = center - q, from_a = center - a, from_b = center - b, from_c = center - c;
  const Vector power(first.dot(from_q + from_a), middle.dot(from_q + from_b), last.dot(from_b + from_c));
  const double squared_radius = std::max(std::max(from_q.squaredNorm(), from_a.squaredNorm()),
                                         std::max(from_b.squaredNorm(), from_c.squaredNorm()));
  const double ff = first.squaredNorm(), mm = middle.squaredNorm(), ll = last.squaredNorm();
  const Vector sum = power.x() * middle.cross(last) + power.y() * last.cross(first) + power.z() * first.cross(middle);
  // No less than the products of two lengths.
  const Vector products(0.5 * (mm + ll), 0.5 * (ll + ff), 0.5 * (ff + mm));
  const double powers_error = 3 * std::sqrt(ff * mm * ll * squared_radius);
  const Determinant volume6 = volume(first, middle, last);
  const double divisor = 2 * (std::abs(volume6.value) - volume6.bound);
  const double off = (sum.norm() + 16 * kRounding * (power.cwiseAbs().dot(products) + powers_error)) / divisor;
  return divisor > 0 ? off : std::numeric_limits<double>::infinity();
}

}  // namespace orchard::detail
