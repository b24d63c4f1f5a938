#include "predicates/placed_sphere.h"

#include <cstddef>

#include "predicates/four_vectors.h"
#include "predicates/vectors.h"

namespace orchard::detail {

#ifdef ORCHARD_FOUR_LANES
namespace {

// The centre and the radius of a vertex are four adjacent doubles, and so are the vector and the square of a point.
static_assert(offsetof(VoronoiVertex, radius) == offsetof(VoronoiVertex, center) + 3 * sizeof(double));
static_assert(offsetof(LengthedVector, squared) == offsetof(LengthedVector, vector) + 3 * sizeof(double));

// Comparisons of four lanes. The sign bit of a lane is set if the comparison, or all of several, hold there.
ORCHARD_AVX2 __m256d less(__m256d a, __m256d b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
template <class... More>
ORCHARD_AVX2 __m256d all(__m256d first, More... more) {
  ((first = _mm256_and_pd(first, more)), ...);
  return first;
}

struct FourClasses {
  __m256i number;  // the exponent of the smallest power of four that is at least the value
  __m256d factor;  // this power, if it is at most kMaxSteps
};
constexpr double kMaxSteps = 0x1p120;

ORCHARD_AVX2 FourClasses error_classes(__m256d steps) {
  const __m256i exponent =
      _mm256_sub_epi64(_mm256_srli_epi64(_mm256_castpd_si256(steps), 52), _mm256_set1_epi64x(1023));
  const __m256i up = _mm256_add_epi64(_mm256_srli_epi64(exponent, 1), _mm256_set1_epi64x(1));
  const __m256i number = _mm256_and_si256(up, _mm256_castpd_si256(less(_mm256_set1_pd(1), steps)));
  const __m256i biased = _mm256_add_epi64(_mm256_slli_epi64(number, 1), _mm256_set1_epi64x(1023));
  return {number, _mm256_castsi256_pd(_mm256_slli_epi64(biased, 52))};
}

struct FourLengthed {
  FourVectors vector;
  __m256d squared, length;
};

ORCHARD_AVX2 FourLengthed load(const std::array<const LengthedVector*, 4>& v) {
  FourLengthed four{{_mm256_loadu_pd(v[0]->vector.data()), _mm256_loadu_pd(v[1]->vector.data()),
                     _mm256_loadu_pd(v[2]->vector.data())},
                    _mm256_loadu_pd(v[3]->vector.data()),
                    _mm256_set_pd(v[3]->length, v[2]->length, v[1]->length, v[0]->length)};
  transpose(four.vector.x, four.vector.y, four.vector.z, four.squared);
  return four;
}

const bool kFourLanes = __builtin_cpu_supports("avx2");

}  // namespace

bool can_place_four() { return kFourLanes; }

// Computes the same as placed_sphere() for four triangles, with the operations in the same order.
[[gnu::target("avx2")]] void place_four(const Point& new_point, const PlacingLimits& limits,
                                        const FourTriangles& triangles, VoronoiVertex* vertices,
                                        FourQualities& qualities) {
  const FourLengthed a = load(triangles.a), b = load(triangles.b), c = load(triangles.c);
  const FourVectors bc = cross(b.vector, c.vector), ca = cross(c.vector, a.vector), ab = cross(a.vector, b.vector);
  const __m256d volume6 = dot(a.vector, bc), absolute_volume = absolute(volume6);
  const __m256d condition = a.length * b.length * c.length / absolute_volume;
  const __m256d max_face = _mm256_sqrt_pd(_mm256_max_pd(_mm256_max_pd(dot(bc, bc), dot(ca, ca)), dot(ab, ab)));
  const __m256d shake = _mm256_set1_pd(limits.noise) * (max_face / absolute_volume);
  const __m256d scale = _mm256_set1_pd(0.5) / volume6;
  const FourVectors q{_mm256_set1_pd(new_point.x()), _mm256_set1_pd(new_point.y()), _mm256_set1_pd(new_point.z())};
  FourVectors center{q.x + (a.squared * bc.x + b.squared * ca.x + c.squared * ab.x) * scale,
                     q.y + (a.squared * bc.y + b.squared * ca.y + c.squared * ab.y) * scale,
                     q.z + (a.squared * bc.z + b.squared * ca.z + c.squared * ab.z) * scale};
  const FourVectors from_new{center.x - q.x, center.y - q.y, center.z - q.z};
  __m256d squared_radius = dot(from_new, from_new);
  const __m256d r = _mm256_sqrt_pd(squared_radius);
  const __m256d sum = absolute(center.x) + absolute(center.y) + absolute(center.z);
  const __m256d error = (_mm256_set1_pd(4 * RelativeCenter::kCenterError) * condition + _mm256_set1_pd(16 * kRounding) +
                         _mm256_set1_pd(8) * shake) *
                            squared_radius +
                        _mm256_set1_pd(8 * kRounding) * r * sum;
  const __m256d steps = error * _mm256_set1_pd(1 / limits.min_bound);
  const FourClasses classes = error_classes(steps);
  const __m256d bound = classes.factor * _mm256_set1_pd(limits.min_bound);
  const __m256d good =
      all(less(condition * _mm256_set1_pd(RelativeCenter::kCenterError), _mm256_set1_pd(0.125)),
          less(condition, _mm256_set1_pd(limits.max_condition)), less(shake, _mm256_set1_pd(limits.max_shake)),
          less(_mm256_setzero_pd(), volume6), less(bound, _mm256_set1_pd(limits.max_poverty) * squared_radius),
          less(steps, _mm256_set1_pd(kMaxSteps)));
  qualities.good = static_cast<unsigned>(_mm256_movemask_pd(good));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(qualities.error_class.data()), classes.number);
  if (qualities.good != 0xf) {
    _mm256_storeu_pd(qualities.volume6.data(), volume6);
    _mm256_storeu_pd(qualities.condition.data(), condition);
    _mm256_storeu_pd(qualities.shake.data(), shake);
    _mm256_storeu_pd(qualities.error.data(), error);
  }
  transpose(center.x, center.y, center.z, squared_radius);
  _mm256_storeu_pd(vertices[0].center.data(), center.x);
  _mm256_storeu_pd(vertices[1].center.data(), center.y);
  _mm256_storeu_pd(vertices[2].center.data(), center.z);
  _mm256_storeu_pd(vertices[3].center.data(), squared_radius);
}
#else
bool can_place_four() { return false; }
void place_four(const Point&, const PlacingLimits&, const FourTriangles&, VoronoiVertex*, FourQualities&) {}
#endif

}  // namespace orchard::detail
