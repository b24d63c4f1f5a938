#include "predicates.h"

#include "expansion.h"
#include "twofold.h"

namespace orchard::detail {
namespace {

// A few dozen operations of 2^-104 relative error each, in terms of the error bound of the same formula in doubles.
constexpr double kSharper = 0x1p-48;

// The vector from q to p in Twofold or Expansion arithmetic: exact, the difference of two doubles being two doubles.
template <class Number>
struct SharpVector {
  Number x, y, z;

  SharpVector(const Number& a, const Number& b, const Number& c) : x(a), y(b), z(c) {}
  SharpVector(const Point& p, const Point& q)
      : x(exact_difference(p.x(), q.x())), y(exact_difference(p.y(), q.y())), z(exact_difference(p.z(), q.z())) {}

  SharpVector cross(const SharpVector& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  Number dot(const SharpVector& o) const { return x * o.x + y * o.y + z * o.z; }
};

// The lifted determinant of four points relative to the query, expanded by the lifts. Positive for a query inside.
template <class Number>
Number lifted(const Number& aa, const Number& bb, const Number& cc, const Number& dd, const Number& bcd,
              const Number& cda, const Number& dab, const Number& abc) {
  return (cc * dab - dd * abc) + (aa * bcd - bb * cda);
}

// In doubles; 16 roundings of the sum of the absolute products bound the error.
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

template <class Number>
Number sharp_volume(const Point& q, const Point& a, const Point& b, const Point& c) {
  using V = SharpVector<Number>;
  return V(a, q).dot(V(b, q).cross(V(c, q)));
}

template <class Number>
Number sharp_inside_sphere(const Point& q, const Point& a, const Point& b, const Point& c, const Point& d) {
  using V = SharpVector<Number>;
  const V va(a, q), vb(b, q), vc(c, q), vd(d, q);
  const V ab = va.cross(vb), cd = vc.cross(vd);
  return lifted(va.dot(va), vb.dot(vb), vc.dot(vc), vd.dot(vd), vb.dot(cd), va.dot(cd), vd.dot(ab), vc.dot(ab));
}

// The same products and sums with the fused operation as one instruction instead of a call: the same results, twice as
// fast.
#if defined(__GNUC__) && defined(__x86_64__)
[[gnu::target("fma"), gnu::flatten]] double fused_inside_sphere(const Point& q, const Point& a, const Point& b,
                                                                const Point& c, const Point& d) {
  return sharp_inside_sphere<Twofold>(q, a, b, c, d).high;
}
[[gnu::target("fma"), gnu::flatten]] double fused_volume(const Point& q, const Point& a, const Point& b,
                                                         const Point& c) {
  return sharp_volume<Twofold>(q, a, b, c).high;
}
const bool kFused = __builtin_cpu_supports("fma");
#else
double fused_inside_sphere(const Point&, const Point&, const Point&, const Point&, const Point&) { return 0; }
double fused_volume(const Point&, const Point&, const Point&, const Point&) { return 0; }
constexpr bool kFused = false;
#endif

}  // namespace

Sign volume_sign(const Point& q, const Point& a, const Point& b, const Point& c, double indifferent) {
  const Determinant fast = volume(a - q, b - q, c - q);
  const Sign sign = sign_of(fast.value, fast.bound + indifferent);
  if (sign != Sign::uncertain || std::abs(fast.value) + fast.bound < indifferent) return sign;
  const Sign sharp = sign_of(kFused ? fused_volume(q, a, b, c) : sharp_volume<Twofold>(q, a, b, c).high,
                             fast.bound * kSharper + indifferent);
  if (sharp != Sign::uncertain || indifferent > 0) return sharp;
  return static_cast<Sign>(sharp_volume<Expansion>(q, a, b, c).sign());
}

Sign inside_sphere(const Point& q, const Point& a, const Point& b, const Point& c, const Point& d) {
  const Determinant fast = inside_sphere_fast(a - q, b - q, c - q, d - q);
  if (fast.sign() != Sign::uncertain) return fast.sign();
  const Sign sharp =
      sign_of(kFused ? fused_inside_sphere(q, a, b, c, d) : sharp_inside_sphere<Twofold>(q, a, b, c, d).high,
              fast.bound * kSharper);
  if (sharp != Sign::uncertain) return sharp;
  return static_cast<Sign>(sharp_inside_sphere<Expansion>(q, a, b, c, d).sign());
}

namespace {

// The circumcentre of q, a, b, c relative to q as four determinants: x, y and z over twice six times the volume.
template <class Number>
struct SharpCenter {
  SharpVector<Number> numerator;
  Number volume6;

  static SharpCenter of(const Point& q, const Point& a, const Point& b, const Point& c) {
    using V = SharpVector<Number>;
    const V va(a, q), vb(b, q), vc(c, q);
    const V bc = vb.cross(vc), ca = vc.cross(va), ab = va.cross(vb);
    const Number aa = va.dot(va), bb = vb.dot(vb), cc = vc.dot(vc);
    return {{bc.x * aa + ca.x * bb + ab.x * cc, bc.y * aa + ca.y * bb + ab.y * cc, bc.z * aa + ca.z * bb + ab.z * cc},
            va.dot(bc)};
  }
};

}  // namespace

bool sharp_circumcenter(const Point& q, const Point& a, const Point& b, const Point& c, Vector& center) {
  const auto sharp = SharpCenter<Twofold>::of(q, a, b, c);
  if (std::abs(sharp.volume6.high) > 0x1p20 * kSharper * volume(a - q, b - q, c - q).bound) {
    const Twofold twice = sharp.volume6 + sharp.volume6;
    center =
        Vector((sharp.numerator.x / twice).high, (sharp.numerator.y / twice).high, (sharp.numerator.z / twice).high);
  } else {
    const auto exact = SharpCenter<Expansion>::of(q, a, b, c);
    center = Vector(exact.numerator.x.value(), exact.numerator.y.value(), exact.numerator.z.value()) /
             (2 * exact.volume6.value());
  }
  return center.allFinite();
}

bool sharp_normal(const Point& q, const Point& a, const Point& b, Vector& normal) {
  using Twice = SharpVector<Twofold>;
  const Twice cross = Twice(a, q).cross(Twice(b, q));
  normal = Vector(cross.x.high, cross.y.high, cross.z.high);
  // Scaled first: the squares of a needle's area may be too small for a double.
  double scale = normal.cwiseAbs().maxCoeff();
  if (!(scale > 0x1p-80 * (a - q).norm() * (b - q).norm())) {
    using Exact = SharpVector<Expansion>;
    const Exact exact = Exact(a, q).cross(Exact(b, q));
    normal = Vector(exact.x.value(), exact.y.value(), exact.z.value());
    scale = normal.cwiseAbs().maxCoeff();
    if (!(scale > 0)) return false;
  }
  normal = (normal / scale).normalized();
  return true;
}

}  // namespace orchard::detail
