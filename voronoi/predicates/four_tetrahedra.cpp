#include "predicates/four_tetrahedra.h"

#include <limits>

#include "predicates/four_vectors.h"
#include "predicates/twofold.h"
#include "predicates/vectors.h"

namespace orchard::detail {

#ifdef ORCHARD_FOUR_LANES
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

// Four numbers of twice the precision, as in Twofold.
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
// Returns the doubles nearest to the quotients.
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

ORCHARD_FUSED FourSharpVectors operator+(const FourSharpVectors& a, const FourSharpVectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

// Returns the second vectors where the mask is set, and the first ones elsewhere.
ORCHARD_FUSED FourVectors choose(const FourVectors& a, const FourVectors& b, __m256d mask) {
  return {_mm256_blendv_pd(a.x, b.x, mask), _mm256_blendv_pd(a.y, b.y, mask), _mm256_blendv_pd(a.z, b.z, mask)};
}

// The minors of inside_sphere_fast() in predicates.cpp.
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

// Does what sharp_inside_sphere() in predicates.cpp does.
ORCHARD_FUSED __m256d sharp_inside_spheres(const FourSharpVectors& a, const FourSharpVectors& b,
                                           const FourSharpVectors& c, const FourSharpVectors& d) {
  const FourSharpVectors ab = cross(a, b), cd = cross(c, d);
  const FourTwofolds first = dot(c, c) * dot(d, ab) - dot(d, d) * dot(c, ab),
                     second = dot(a, a) * dot(b, cd) - dot(b, b) * dot(a, cd);
  return (first + second).high;
}

// Returns the differences of the powers of two points.
ORCHARD_FUSED __m256d sharp_powers(const FourVectors& center, const FourVectors& p, const FourVectors& q) {
  return dot(differences(p, q), differences(center, q) + differences(center, p)).high;
}

// Does what off_circumcenter() does, in the same order of operations.
template <bool kSharp>
ORCHARD_FUSED FourOffCenters off_centers(const std::array<const Point*, 4>& centers, const FourTetrahedra& tetrahedra) {
  const FourVectors q = load_four(tetrahedra[3]), p1 = load_four(tetrahedra[0]), p2 = load_four(tetrahedra[1]),
                    p3 = load_four(tetrahedra[2]), center = load_four(centers);
  const __m256d with_a = squared(p1 - q) * squared(p3 - p2), with_b = squared(p2 - q) * squared(p1 - p3),
                with_c = squared(p3 - q) * squared(p2 - p1);
  const __m256d is_b = _mm256_cmp_pd(with_b, with_a, _CMP_LT_OQ);
  const __m256d is_c = _mm256_cmp_pd(with_c, _mm256_min_pd(with_a, with_b), _CMP_LT_OQ);
  const FourVectors a_or_b = choose(p1, p2, is_b);
  const FourVectors a = choose(a_or_b, p3, is_c), b = choose(p2, p1, is_b), c = choose(p3, a_or_b, is_c);
  const FourVectors first = a - q, middle = b - q, last = c - b;
  const FourVectors from_q = center - q, from_a = center - a, from_b = center - b, from_c = center - c;
  FourVectors power{dot(first, from_q + from_a), dot(middle, from_q + from_b), dot(last, from_b + from_c)};
  if constexpr (kSharp) power = {sharp_powers(center, a, q), sharp_powers(center, b, q), sharp_powers(center, c, b)};
  const __m256d squared_radius =
      _mm256_max_pd(_mm256_max_pd(squared(from_q), squared(from_a)), _mm256_max_pd(squared(from_b), squared(from_c)));
  const __m256d ff = squared(first), mm = squared(middle), ll = squared(last);
  const FourVectors ml = cross(middle, last), lf = cross(last, first), fm = cross(first, middle);
  const FourVectors sum{power.x * ml.x + power.y * lf.x + power.z * fm.x,
                        power.x * ml.y + power.y * lf.y + power.z * fm.y,
                        power.x * ml.z + power.y * lf.z + power.z * fm.z};
  const FourVectors products{all_four(0.5) * (mm + ll), all_four(0.5) * (ll + ff), all_four(0.5) * (ff + mm)};
  const __m256d powers_error = all_four(kSharp ? 3 * kSharper : 3) * _mm256_sqrt_pd(ff * mm * ll * squared_radius);
  const FourDeterminants volume6 = volumes(first, middle, last);
  const __m256d divisor = all_four(2) * (absolute(volume6.value) - volume6.bound);
  const __m256d size = length(sum), error = all_four(16 * kRounding) * (dot(absolute(power), products) + powers_error);
  const __m256d of_volume = volume6.bound / absolute(volume6.value) + all_four(8 * kRounding);
  const __m256d infinite = all_four(std::numeric_limits<double>::infinity()),
                is_told = _mm256_cmp_pd(divisor, _mm256_setzero_pd(), _CMP_GT_OQ),
                per_volume = all_four(0.5) / volume6.value;
  FourOffCenters result;
  _mm256_storeu_pd(result.off.data(), _mm256_blendv_pd(infinite, (size + error) / divisor, is_told));
  _mm256_storeu_pd(result.rest.data(), _mm256_blendv_pd(infinite, (error + size * of_volume) / divisor, is_told));
  _mm256_storeu_pd(result.x.data(), sum.x * per_volume);
  _mm256_storeu_pd(result.y.data(), sum.y * per_volume);
  _mm256_storeu_pd(result.z.data(), sum.z * per_volume);
  return result;
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

[[gnu::target("avx2,fma")]] FourOffCenters off_four_circumcenters(const std::array<const Point*, 4>& centers,
                                                                  const FourTetrahedra& tetrahedra) {
  return off_centers<false>(centers, tetrahedra);
}
[[gnu::target("avx2,fma")]] FourOffCenters sharply_off_four_circumcenters(const std::array<const Point*, 4>& centers,
                                                                          const FourTetrahedra& tetrahedra) {
  return off_centers<true>(centers, tetrahedra);
}

// Does what SharpCenter in predicates.cpp does, in the same order of operations.
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
FourOffCenters off_four_circumcenters(const std::array<const Point*, 4>&, const FourTetrahedra&) { return {}; }
FourOffCenters sharply_off_four_circumcenters(const std::array<const Point*, 4>&, const FourTetrahedra&) { return {}; }
unsigned four_sharp_circumcenters(const FourTetrahedra&, std::array<Vector, 4>&) { return 0; }
#endif

}  // namespace orchard::detail
