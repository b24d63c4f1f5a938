#include "predicates/predicates.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "predicates/exact_integer.h"
#include "predicates/short_integer.h"
#include "predicates/twofold.h"
#include "predicates/vectors.h"

namespace orchard::detail {
namespace {

Sign exact_sign(const ExactInteger& number) { return static_cast<Sign>(number.sign()); }

// A vector whose coordinates are Twofold or exact integers.
template <class Number>
struct SharpVector {
  Number x, y, z;

  SharpVector cross(const SharpVector& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  Number dot(const SharpVector& o) const { return x * o.x + y * o.y + z * o.z; }
};

// Returns the vectors from q to the points. They are exact, because the difference of two doubles is the sum of two
// doubles.
template <class... Points>
auto twofold_vectors(const Point& q, const Points&... points) {
  const auto from_q = [&](const Point& p) {
    return SharpVector<Twofold>{exact_difference(p.x(), q.x()), exact_difference(p.y(), q.y()),
                                exact_difference(p.z(), q.z())};
  };
  return std::array{from_q(points)...};
}

// The same in units of a power of two of which all coordinates are multiples.
template <class... Points>
auto integer_vectors(const Point& q, const Points&... points) {
  const int unit = common_unit({&q, &points...});
  const std::array<ExactInteger, 3> origin{in_units(q.x(), unit), in_units(q.y(), unit), in_units(q.z(), unit)};
  const auto from_q = [&](const Point& p) {
    return SharpVector<ExactInteger>{in_units(p.x(), unit) - origin[0], in_units(p.y(), unit) - origin[1],
                                     in_units(p.z(), unit) - origin[2]};
  };
  return std::array{from_q(points)...};
}

// Integers for differences with few digits: 61 bits for each, two words for the products and the sums of two of them,
// three for volumes and five for the lifted determinant.
struct ShortVector {
  using Volume = ShortInteger<3>;
  std::int64_t x, y, z;

  std::array<TwoWords, 3> cross(const ShortVector& o) const {
    return {product(y, o.z) - product(z, o.y), product(z, o.x) - product(x, o.z), product(x, o.y) - product(y, o.x)};
  }
  TwoWords squared() const { return product(x, x) + product(y, y) + product(z, z); }
  Volume dot(const std::array<TwoWords, 3>& o) const {
    return Volume(TwoWords(x)) * Volume(o[0]) + Volume(TwoWords(y)) * Volume(o[1]) + Volume(TwoWords(z)) * Volume(o[2]);
  }

 private:
  static TwoWords product(std::int64_t a, std::int64_t b) { return TwoWords(a) * b; }
};

// Does what integer_vectors() does if all coordinates fit; returns false otherwise.
template <std::size_t kCount, class... Points>
bool short_vectors(std::array<ShortVector, kCount>& vectors, const Point& q, const Points&... points) {
  constexpr int kShortBits = 60;  // of a coordinate, so that the sums of three products of differences are below 2^124
  const int unit = common_unit({&q, &points...});
  bool fits = true;
  const auto in_short_units = [&](double x) -> std::int64_t {
    const Binary binary(x);
    if (binary.mantissa == 0) return 0;
    const int shift = binary.exponent - unit;
    if (shift < 0) return binary.mantissa / (std::int64_t{1} << -shift);
    fits = fits && shift + 53 <= kShortBits;
    return fits ? binary.mantissa * (std::int64_t{1} << shift) : 0;
  };
  const auto short_vector = [&](const Point& p) {
    return ShortVector{in_short_units(p.x()), in_short_units(p.y()), in_short_units(p.z())};
  };
  const ShortVector origin = short_vector(q);
  vectors = {short_vector(points)...};
  for (ShortVector& v : vectors) v = {v.x - origin.x, v.y - origin.y, v.z - origin.z};
  return fits;
}

// The lifted determinant of four points relative to the query, expanded along the lifts. It is positive if the query is
// inside.
template <class Number>
Number lifted(const Number& aa, const Number& bb, const Number& cc, const Number& dd, const Number& bcd,
              const Number& cda, const Number& dab, const Number& abc) {
  return (cc * dab - dd * abc) + (aa * bcd - bb * cda);
}

// Computes it in doubles. 16 rounding errors of the sum of the absolute products bound its error.
Determinant inside_sphere_fast(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  struct Minor {
    double value, magnitude;
  };
  const auto minor2 = [](const Vector& u, const Vector& v) {
    const double p = u.x() * v.y(), q = v.x() * u.y();
    return Minor{p - q, std::abs(p) + std::abs(q)};
  };
  const Minor ab = minor2(a, b), bc = minor2(b, c), cd = minor2(c, d), da = minor2(d, a), ac = minor2(a, c),
              bd = minor2(b, d);
  const double az = std::abs(a.z()), bz = std::abs(b.z()), cz = std::abs(c.z()), dz = std::abs(d.z());
  const double abc = a.z() * bc.value - b.z() * ac.value + c.z() * ab.value;
  const double bcd = b.z() * cd.value - c.z() * bd.value + d.z() * bc.value;
  const double cda = c.z() * da.value + d.z() * ac.value + a.z() * cd.value;
  const double dab = d.z() * ab.value + a.z() * bd.value + b.z() * da.value;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm(), dd = d.squaredNorm();
  const double magnitude = aa * (bz * cd.magnitude + cz * bd.magnitude + dz * bc.magnitude) +
                           bb * (cz * da.magnitude + dz * ac.magnitude + az * cd.magnitude) +
                           cc * (dz * ab.magnitude + az * bd.magnitude + bz * da.magnitude) +
                           dd * (az * bc.magnitude + bz * ac.magnitude + cz * ab.magnitude);
  return {lifted(aa, bb, cc, dd, bcd, cda, dab, abc), 16 * kRounding * magnitude};
}

// Whether the doubles of a determinant of this degree are exact. They are if all coordinates are multiples of a unit of
// which no difference is more than 2^bits, so that every intermediate product and sum is a whole number of units below
// 2^53. Nearly all adjacent points of a grid fulfil this, and the test is much faster than any exact arithmetic that
// would show them to be on one plane or sphere. `extent` is the largest difference from q.
template <class... Points>
bool is_exact_in_doubles(int bits, double extent, const Point& q, const Points&... points) {
  const double below = std::bit_cast<double>(std::bit_cast<std::uint64_t>(extent) & (std::uint64_t{0x7ff} << 52));
  // Adding this number to one that is not negative rounds it to multiples of the unit, or of a larger one: 2^(1 - bits)
  // times the power of two below the extent.
  const double rounder = 0x1.8p53 / static_cast<double>(1 << bits) * below;
  const auto is_whole = [rounder](double x) { return (std::abs(x) + rounder) - rounder == std::abs(x); };
  const auto is_multiple = [&is_whole](const Point& p) {
    return is_whole(p.x()) && is_whole(p.y()) && is_whole(p.z());
  };
  return is_multiple(q) && (is_multiple(points) && ...);
}
constexpr int kVolumeBits = 16;  // 6 products of three differences: below 2^51
constexpr int kSphereBits = 9;   // 72 products of five: below 2^52

// Whether four points, seen along an axis, are at most two points. Then they are exactly in one plane, however many
// digits they have. This holds for many points in rings or rows along an axis.
bool are_two_along_axis(const Point& q, const Point& a, const Point& b, const Point& c) {
  // Returns a bit for each axis along which the two points coincide.
  const auto one = [](const Point& u, const Point& v) {
    const unsigned x = u.x() == v.x(), y = u.y() == v.y(), z = u.z() == v.z();
    return (y & z) | (x & z) << 1 | (x & y) << 2;
  };
  const unsigned qa = one(q, a), qb = one(q, b), qc = one(q, c), ab = one(a, b), ac = one(a, c), bc = one(b, c);
  return ((qa & bc) | (qb & ac) | (qc & ab) | (qa & qb) | (qa & qc) | (qb & qc) | (ab & ac)) != 0;
}

template <class... Vectors>
double largest_coordinate(const Vectors&... vectors) {
  return std::max({vectors.cwiseAbs().maxCoeff()...});
}

template <class Number>
Number sharp_volume(const std::array<SharpVector<Number>, 3>& v) {
  return v[0].dot(v[1].cross(v[2]));
}

Sign exact_volume_sign(const Point& q, const Point& a, const Point& b, const Point& c) {
  std::array<ShortVector, 3> v;
  if (short_vectors(v, q, a, b, c)) return static_cast<Sign>(v[0].dot(v[1].cross(v[2])).sign());
  return exact_sign(sharp_volume(integer_vectors(q, a, b, c)));
}

template <class Number>
Number sharp_inside_sphere(const std::array<SharpVector<Number>, 4>& v) {
  const auto& [a, b, c, d] = v;
  const SharpVector<Number> ab = a.cross(b), cd = c.cross(d);
  return lifted<Number>(a.dot(a), b.dot(b), c.dot(c), d.dot(d), b.dot(cd), a.dot(cd), d.dot(ab), c.dot(ab));
}

// The circumcentre of q, a, b, c relative to q as four determinants: x, y and z have to be divided by twice six times
// the volume.
template <class Number>
struct SharpCenter {
  SharpVector<Number> numerator;
  Number volume6;

  static SharpCenter of(const std::array<SharpVector<Number>, 3>& v) {
    const auto& [a, b, c] = v;
    const SharpVector<Number> bc = b.cross(c), ca = c.cross(a), ab = a.cross(b);
    const Number aa = a.dot(a), bb = b.dot(b), cc = c.dot(c);
    return {{bc.x * aa + ca.x * bb + ab.x * cc, bc.y * aa + ca.y * bb + ab.y * cc, bc.z * aa + ca.z * bb + ab.z * cc},
            a.dot(bc)};
  }
};

// The quotient and its divisor.
struct RoundedCenter {
  Vector center;
  double volume6 = 0;
};
inline RoundedCenter rounded_center(const Point& q, const Point& a, const Point& b, const Point& c) {
  const auto [numerator, volume6] = SharpCenter<Twofold>::of(twofold_vectors(q, a, b, c));
  const Twofold twice = volume6 + volume6;
  return {Vector((numerator.x / twice).high, (numerator.y / twice).high, (numerator.z / twice).high), volume6.high};
}

Sign exact_inside_sphere(const Point& q, const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<ShortVector, 4> v;
  if (!short_vectors(v, q, a, b, c, d)) return exact_sign(sharp_inside_sphere(integer_vectors(q, a, b, c, d)));
  using Lifted = ShortInteger<5>;
  const std::array<TwoWords, 3> ab = v[0].cross(v[1]), cd = v[2].cross(v[3]);
  const auto squared = [&v](unsigned i) { return Lifted(v[i].squared()); };
  return static_cast<Sign>(lifted<Lifted>(squared(0), squared(1), squared(2), squared(3), Lifted(v[1].dot(cd)),
                                          Lifted(v[0].dot(cd)), Lifted(v[3].dot(ab)), Lifted(v[2].dot(ab)))
                               .sign());
}

// A variant in which the fused operation is an instruction and not a call. It makes the same products and sums with the
// same results, twice as fast.
#ifdef ORCHARD_FOUR_LANES
[[gnu::target("fma"), gnu::flatten]] double fused_inside_sphere(const Point& q, const Point& a, const Point& b,
                                                                const Point& c, const Point& d) {
  return sharp_inside_sphere(twofold_vectors(q, a, b, c, d)).high;
}
[[gnu::target("fma"), gnu::flatten]] double fused_volume(const Point& q, const Point& a, const Point& b,
                                                         const Point& c) {
  return sharp_volume(twofold_vectors(q, a, b, c)).high;
}
[[gnu::target("fma"), gnu::flatten]] RoundedCenter fused_center(const Point& q, const Point& a, const Point& b,
                                                                const Point& c) {
  return rounded_center(q, a, b, c);
}
const bool kFused = __builtin_cpu_supports("fma");
#else
double fused_inside_sphere(const Point&, const Point&, const Point&, const Point&, const Point&) { return 0; }
double fused_volume(const Point&, const Point&, const Point&, const Point&) { return 0; }
RoundedCenter fused_center(const Point&, const Point&, const Point&, const Point&) { return {}; }
constexpr bool kFused = false;
#endif

// Computes the centre with twice the digits of doubles. Returns whether the volume is more than `times` times its
// error.
bool twofold_circumcenter(double times, const Point& q, const Point& a, const Point& b, const Point& c,
                          Vector& center) {
  const RoundedCenter sharp = kFused ? fused_center(q, a, b, c) : rounded_center(q, a, b, c);
  center = sharp.center;
  return std::abs(sharp.volume6) > times * kSharper * volume(a - q, b - q, c - q).bound;
}

}  // namespace

Sign volume_sign(const Point& q, const Point& a, const Point& b, const Point& c, double indifferent) {
  const Vector qa = a - q, qb = b - q, qc = c - q;
  const Determinant fast = volume(qa, qb, qc);
  const Sign sign = sign_of(fast.value, fast.bound + indifferent);
  if (sign != Sign::uncertain || std::abs(fast.value) + fast.bound < indifferent) return sign;
  if (indifferent == 0) {
    // Every product of the determinant has a factor 0, which is so if all four points share a coordinate.
    if (fast.bound == 0) return Sign::uncertain;
    if (is_exact_in_doubles(kVolumeBits, largest_coordinate(qa, qb, qc), q, a, b, c)) return sign_of(fast.value, 0);
    if (are_two_along_axis(q, a, b, c)) return Sign::uncertain;
  }
  const Sign sharp = sign_of(kFused ? fused_volume(q, a, b, c) : sharp_volume(twofold_vectors(q, a, b, c)).high,
                             fast.bound * kSharper + indifferent);
  if (sharp != Sign::uncertain || indifferent > 0) return sharp;
  return exact_volume_sign(q, a, b, c);
}

Sign volume_sign_of_middle(const std::array<Point, 4>& points, const Point& a, const Point& b, const Point& c) {
  const auto& [p, q, r, s] = points;
  const auto [to_a, to_b, to_c, to_q, to_r, to_s] = integer_vectors(p, a, b, c, q, r, s);
  // all four are scaled by the same factor
  const SharpVector<ExactInteger> to_middle{to_q.x + to_r.x + to_s.x, to_q.y + to_r.y + to_s.y,
                                            to_q.z + to_r.z + to_s.z};
  const auto from_middle = [&to_middle](const SharpVector<ExactInteger>& v) {
    return SharpVector<ExactInteger>{4 * v.x - to_middle.x, 4 * v.y - to_middle.y, 4 * v.z - to_middle.z};
  };
  return exact_sign(sharp_volume(std::array{from_middle(to_a), from_middle(to_b), from_middle(to_c)}));
}

Sign same_side_of_line(const Point& a, const Point& b, const Point& p, const Point& q) {
  const Vector along = b - a, to_p = p - a, to_q = q - a;
  const double value = along.cross(to_p).dot(along.cross(to_q));
  const Sign fast = sign_of(value, 32 * kRounding * along.squaredNorm() * to_p.norm() * to_q.norm());
  if (fast != Sign::uncertain) return fast;
  const auto [ab, ap, aq] = integer_vectors(a, b, p, q);
  return exact_sign(ab.cross(ap).dot(ab.cross(aq)));
}

Sign inside_sphere(const Point& q, const Point& a, const Point& b, const Point& c, const Point& d) {
  const Vector qa = a - q, qb = b - q, qc = c - q, qd = d - q;
  const Determinant fast = inside_sphere_fast(qa, qb, qc, qd);
  if (fast.sign() != Sign::uncertain) return fast.sign();
  if (is_exact_in_doubles(kSphereBits, largest_coordinate(qa, qb, qc, qd), q, a, b, c, d))
    return sign_of(fast.value, 0);
  const Sign sharp =
      sign_of(kFused ? fused_inside_sphere(q, a, b, c, d) : sharp_inside_sphere(twofold_vectors(q, a, b, c, d)).high,
              fast.bound * kSharper);
  if (sharp != Sign::uncertain) return sharp;
  return exact_inside_sphere(q, a, b, c, d);
}

bool rough_circumcenter(const Point& q, const Point& a, const Point& b, const Point& c, Vector& center) {
  constexpr double kRough = 0x1p7;
  return twofold_circumcenter(kRough, q, a, b, c, center) && center.allFinite();
}

bool sharp_circumcenter(const Point& q, const Point& a, const Point& b, const Point& c, Vector& center) {
  if (!twofold_circumcenter(kDivisible, q, a, b, c, center)) {
    const auto exact = SharpCenter<ExactInteger>::of(integer_vectors(q, a, b, c));
    if (exact.volume6 == 0) return false;
    const int unit = common_unit({&q, &a, &b, &c}) - 1;  // the factor is twice six times the volume
    center = Vector(quotient(exact.numerator.x, exact.volume6, unit), quotient(exact.numerator.y, exact.volume6, unit),
                    quotient(exact.numerator.z, exact.volume6, unit));
  }
  return center.allFinite();
}

bool sharp_normal(const Point& q, const Point& a, const Point& b, Vector& normal) {
  const auto [qa, qb] = twofold_vectors(q, a, b);
  const auto cross = qa.cross(qb);
  normal = Vector(cross.x.high, cross.y.high, cross.z.high);
  // The vector is scaled first, because the squares of a needle's area may underflow.
  double scale = normal.cwiseAbs().maxCoeff();
  if (!(scale > kDivisible * kSharper * kRounding * (a - q).norm() * (b - q).norm())) {
    const auto [exact_a, exact_b] = integer_vectors(q, a, b);
    const auto exact = exact_a.cross(exact_b);
    const ExactInteger max = std::max({abs(exact.x), abs(exact.y), abs(exact.z)});
    if (max == 0) return false;
    normal = Vector(quotient(exact.x, max, 0), quotient(exact.y, max, 0), quotient(exact.z, max, 0));
    scale = 1;
  }
  normal = (normal / scale).normalized();
  return true;
}

}  // namespace orchard::detail
