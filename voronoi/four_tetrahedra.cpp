#include "four_tetrahedra.h"

#include "four_vectors.h"
#include "twofold.h"

namespace orchard::detail {

#if defined(__GNUC__) && defined(__x86_64__)
namespace {

#define ORCHARD_FUSED [[gnu::target("avx2,fma"), gnu::always_inline]] inline

struct FourDeterminants {
  __m256d value, bound;
};

ORCHARD_FUSED FourDeterminants volumes(const FourVectors& a, const FourVectors& b, const FourVectors& c) {
  const __m256d yz = b.y * c.z, zy = b.z * c.y, zx = b.z * c.x, xz = b.x * c.z, xy = b.x * c.y, yx = b.y * c.x;
  const FourVectors magnitude = absolute(a);
  return {a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx),
          all_four(8 * kRounding) *
              (magnitude.x * (absolute(yz) + absolute(zy)) + magnitude.y * (absolute(zx) + absolute(xz)) +
               magnitude.z * (absolute(xy) + absolute(yx)))};
}

// As Twofold.
struct FourTwofolds {
  __m256d high, low;
};

ORCHARD_FUSED FourTwofolds exact_sums(__m256d a, __m256d b) {
  const __m256d sum = a + b, b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}
ORCHARD_FUSED FourTwofolds exact_differences(__m256d a, __m256d b) { return exact_sums(a, -b); }
ORCHARD_FUSED FourTwofolds exact_products(__m256d a, __m256d b) {
  const __m256d product = a * b;
  return {product, _mm256_fmsub_pd(a, b, product)};
}
ORCHARD_FUSED FourTwofolds quick_sums(__m256d a, __m256d b) {
  const __m256d sum = a + b;
  return {sum, b - (sum - a)};
}
ORCHARD_FUSED FourTwofolds operator+(const FourTwofolds& a, const FourTwofolds& b) {
  const FourTwofolds high = exact_sums(a.high, b.high);
  return quick_sums(high.high, high.low + (a.low + b.low));
}
ORCHARD_FUSED FourTwofolds operator-(const FourTwofolds& a, const FourTwofolds& b) {
  return a + FourTwofolds{-b.high, -b.low};
}
ORCHARD_FUSED FourTwofolds operator*(const FourTwofolds& a, const FourTwofolds& b) {
  const FourTwofolds p = exact_products(a.high, b.high);
  return quick_sums(p.high, p.low + (a.high * b.low + a.low * b.high));
}
// The double next to the quotient.
ORCHARD_FUSED __m256d quotients(const FourTwofolds& a, const FourTwofolds& b) {
  const __m256d first = a.high / b.high;
  const FourTwofolds rest = a - b * FourTwofolds{first, _mm256_setzero_pd()};
  return first + rest.high / b.high;
}

struct FourSharpVectors {
  FourTwofolds x, y, z;
};

ORCHARD_FUSED FourSharpVectors differences(const FourVectors& a, const FourVectors& b) {
  return {exact_differences(a.x, b.x), exact_differences(a.y, b.y), exact_differences(a.z, b.z)};
}
ORCHARD_FUSED FourSharpVectors cross(const FourSharpVectors& a, const FourSharpVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
ORCHARD_FUSED FourTwofolds dot(const FourSharpVectors& a, const FourSharpVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// One coordinate of one point's sharp power: what it adds to it.
ORCHARD_FUSED void add_power(const FourTwofolds& point, const FourTwofolds& twice_center, FourTwofolds& power) {
  const FourTwofolds rest = exact_differences(twice_center.high, point.high);
  const __m256d rest_low = rest.low + (twice_center.low - point.low);
  const FourTwofolds product = exact_products(point.high, rest.high), sum = exact_sums(power.high, product.high);
  power.high = sum.high;
  power.low = power.low + ((sum.low + product.low) + (point.high * rest_low + point.low * rest.high));
}
ORCHARD_FUSED __m256d sharp_powers(const FourSharpVectors& point, const FourSharpVectors& twice_center) {
  FourTwofolds power{_mm256_setzero_pd(), _mm256_setzero_pd()};
  add_power(point.x, twice_center.x, power);
  add_power(point.y, twice_center.y, power);
  add_power(point.z, twice_center.z, power);
  return power.high + power.low;
}

ORCHARD_FUSED FourTwofolds doubled(const FourTwofolds& a) { return {all_four(2) * a.high, all_four(2) * a.low}; }
ORCHARD_FUSED FourSharpVectors doubled(const FourSharpVectors& a) { return {doubled(a.x), doubled(a.y), doubled(a.z)}; }

// How far a centre is off, at most, by the powers of three points.
struct FourOffBounds {
  FourVectors bc, ca, ab, products;
  __m256d powers_error, divisor;

  ORCHARD_FUSED __m256d of(const FourVectors& power, double sharpness) const {
    const FourVectors sum{power.x * bc.x + power.y * ca.x + power.z * ab.x,
                          power.x * bc.y + power.y * ca.y + power.z * ab.y,
                          power.x * bc.z + power.y * ca.z + power.z * ab.z};
    return (length(sum) +
            all_four(16 * kRounding) * (dot(absolute(power), products) + all_four(sharpness) * powers_error)) /
           divisor;
  }
};

// As inside_sphere_fast() in predicates.cpp.
struct FourMinors {
  __m256d value, magnitude;
};
ORCHARD_FUSED FourMinors minors(const FourVectors& u, const FourVectors& v) {
  const __m256d p = u.x * v.y, q = v.x * u.y;
  return {p - q, absolute(p) + absolute(q)};
}
ORCHARD_FUSED FourDeterminants inside_spheres(const FourVectors& a, const FourVectors& b, const FourVectors& c,
                                              const FourVectors& d) {
  const FourMinors ab = minors(a, b), bc = minors(b, c), cd = minors(c, d), da = minors(d, a), ac = minors(a, c),
                   bd = minors(b, d);
  const __m256d az = absolute(a.z), bz = absolute(b.z), cz = absolute(c.z), dz = absolute(d.z);
  const __m256d abc = a.z * bc.value - b.z * ac.value + c.z * ab.value,
                bcd = b.z * cd.value - c.z * bd.value + d.z * bc.value,
                cda = c.z * da.value + d.z * ac.value + a.z * cd.value,
                dab = d.z * ab.value + a.z * bd.value + b.z * da.value;
  const __m256d aa = dot(a, a), bb = dot(b, b), cc = dot(c, c), dd = dot(d, d);
  const __m256d magnitude = aa * (bz * cd.magnitude + cz * bd.magnitude + dz * bc.magnitude) +
                            bb * (cz * da.magnitude + dz * ac.magnitude + az * cd.magnitude) +
                            cc * (dz * ab.magnitude + az * bd.magnitude + bz * da.magnitude) +
                            dd * (az * bc.magnitude + bz * ac.magnitude + cz * ab.magnitude);
  return {(cc * dab - dd * abc) + (aa * bcd - bb * cda), all_four(16 * kRounding) * magnitude};
}

// As sharp_inside_sphere() there.
ORCHARD_FUSED __m256d sharp_inside_spheres(const FourSharpVectors& a, const FourSharpVectors& b,
                                           const FourSharpVectors& c, const FourSharpVectors& d) {
  const FourSharpVectors ab = cross(a, b), cd = cross(c, d);
  const FourTwofolds first = dot(c, c) * dot(d, ab) - dot(d, d) * dot(c, ab),
                     second = dot(a, a) * dot(b, cd) - dot(b, b) * dot(a, cd);
  return (first + second).high;
}

#undef ORCHARD_FUSED

const bool kFourSharpLanes = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");

}  // namespace

bool can_take_four() { return kFourSharpLanes; }

[[gnu::target("avx2,fma")]] FourVolumes four_volumes(const FourTetrahedra& tetrahedra) {
  const FourVectors a = load_four(tetrahedra[0]), b = load_four(tetrahedra[1]), c = load_four(tetrahedra[2]),
                    q = load_four(tetrahedra[3]);
  const FourDeterminants six = volumes(a - q, b - q, c - q);
  FourVolumes result;
  _mm256_storeu_pd(result.value.data(), six.value);
  _mm256_storeu_pd(result.bound.data(), six.bound);
  return result;
}

[[gnu::target("avx2,fma")]] std::array<Sign, 4> four_inside_spheres(const Point& q, const FourTetrahedra& tetrahedra) {
  const FourVectors from{all_four(q.x()), all_four(q.y()), all_four(q.z())};
  const FourVectors a = load_four(tetrahedra[0]), b = load_four(tetrahedra[1]), c = load_four(tetrahedra[2]),
                    d = load_four(tetrahedra[3]);
  FourDeterminants det = inside_spheres(a - from, b - from, c - from, d - from);
  if (lanes_of(_mm256_cmp_pd(absolute(det.value), det.bound, _CMP_GT_OQ)) != 0xf) {
    det.value =
        sharp_inside_spheres(differences(a, from), differences(b, from), differences(c, from), differences(d, from));
    det.bound = all_four(kSharper) * det.bound;
  }
  const unsigned inside = lanes_of(_mm256_cmp_pd(det.value, det.bound, _CMP_GT_OQ)),
                 outside = lanes_of(_mm256_cmp_pd(det.value, -det.bound, _CMP_LT_OQ));
  std::array<Sign, 4> signs;
  for (unsigned i = 0; i < 4; ++i)
    signs[i] = static_cast<Sign>(static_cast<int>((inside >> i) & 1u) - static_cast<int>((outside >> i) & 1u));
  return signs;
}

// As off_circumcenter(), in the same order of operations.
[[gnu::target("avx2,fma")]] std::array<double, 4> off_four_circumcenters(const FourCenters& centers,
                                                                         const FourTetrahedra& tetrahedra) {
  const FourVectors q = load_four(tetrahedra[3]), a = load_four(tetrahedra[0]), b = load_four(tetrahedra[1]),
                    c = load_four(tetrahedra[2]), center = load_four(centers.center);
  const __m256d enough = _mm256_loadu_pd(centers.enough.data());
  const FourVectors qa = a - q, qb = b - q, qc = c - q, from_q = center - q;
  const FourVectors twice{all_four(2) * from_q.x, all_four(2) * from_q.y, all_four(2) * from_q.z};
  const FourDeterminants volume6 = volumes(qa, qb, qc);
  const __m256d aa = dot(qa, qa), bb = dot(qb, qb), cc = dot(qc, qc);
  const FourOffBounds bounds{
      cross(qb, qc),
      cross(qc, qa),
      cross(qa, qb),
      {all_four(0.5) * (bb + cc), all_four(0.5) * (cc + aa), all_four(0.5) * (aa + bb)},
      _mm256_sqrt_pd(aa * bb * cc) * (all_four(3) * length(twice) + _mm256_sqrt_pd(all_four(3) * (aa + bb + cc))),
      all_four(2) * (absolute(volume6.value) - volume6.bound)};
  __m256d off = bounds.of({dot(qa, twice - qa), dot(qb, twice - qb), dot(qc, twice - qc)}, 1);
  const __m256d suffices =
      _mm256_and_pd(_mm256_cmp_pd(all_four(16 * kRounding) * bounds.powers_error, enough * bounds.divisor, _CMP_LT_OQ),
                    _mm256_cmp_pd(off, enough, _CMP_LE_OQ));
  if (_mm256_movemask_pd(suffices) != 0xf) {
    const FourSharpVectors twice_center = doubled(differences(center, q));
    const FourVectors powers{sharp_powers(differences(a, q), twice_center),
                             sharp_powers(differences(b, q), twice_center),
                             sharp_powers(differences(c, q), twice_center)};
    off = _mm256_blendv_pd(bounds.of(powers, kSharper), off, suffices);
  }
  std::array<double, 4> result;
  _mm256_storeu_pd(result.data(), off);
  return result;
}

// As SharpCenter in predicates.cpp, in the same order of operations.
[[gnu::target("avx2,fma")]] unsigned four_sharp_circumcenters(const FourTetrahedra& tetrahedra,
                                                              std::array<Vector, 4>& centers) {
  const FourVectors q = load_four(tetrahedra[0]), p1 = load_four(tetrahedra[1]), p2 = load_four(tetrahedra[2]),
                    p3 = load_four(tetrahedra[3]);
  const FourSharpVectors a = differences(p1, q), b = differences(p2, q), c = differences(p3, q);
  const FourSharpVectors bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const FourTwofolds aa = dot(a, a), bb = dot(b, b), cc = dot(c, c), volume6 = dot(a, bc), twice = volume6 + volume6;
  const FourVectors center{quotients(bc.x * aa + ca.x * bb + ab.x * cc, twice),
                           quotients(bc.y * aa + ca.y * bb + ab.y * cc, twice),
                           quotients(bc.z * aa + ca.z * bb + ab.z * cc, twice)};
  const __m256d bound = all_four(kDivisible * kSharper) * volumes(p1 - q, p2 - q, p3 - q).bound;
  std::array<double, 4> x, y, z;
  _mm256_storeu_pd(x.data(), center.x);
  _mm256_storeu_pd(y.data(), center.y);
  _mm256_storeu_pd(z.data(), center.z);
  auto found = static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(absolute(volume6.high), bound, _CMP_GT_OQ)));
  for (unsigned i = 0; i < 4; ++i) {
    centers[i] = Vector(x[i], y[i], z[i]);
    if (!centers[i].allFinite()) found &= ~(1u << i);
  }
  return found;
}
#else
bool can_take_four() { return false; }
FourVolumes four_volumes(const FourTetrahedra&) { return {}; }
std::array<Sign, 4> four_inside_spheres(const Point&, const FourTetrahedra&) { return {}; }
std::array<double, 4> off_four_circumcenters(const FourCenters&, const FourTetrahedra&) { return {}; }
unsigned four_sharp_circumcenters(const FourTetrahedra&, std::array<Vector, 4>&) { return 0; }
#endif

}  // namespace orchard::detail
