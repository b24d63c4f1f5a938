#pragma once
#include "predicates/vectors.h"

#ifdef ORCHARD_FOUR_LANES
#include <immintrin.h>

#include <array>
#include <cstdint>

#include "orchard/geometry/mesh.h"
#include "predicates/vectors.h"

// Four vectors at once, for functions that are compiled for AVX2 and selected when the program runs. The operations are
// in the order of Eigen's, so all bits are the same. Everything is inlined, because functions for different instruction
// sets cannot call each other efficiently.
namespace orchard::detail {

#define ORCHARD_AVX2 [[gnu::target("avx2"), gnu::always_inline]] inline

struct FourVectors {
  __m256d x, y, z;
};

ORCHARD_AVX2 __m256d all_four(double value) { return _mm256_set1_pd(value); }
ORCHARD_AVX2 __m256d absolute(__m256d a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
ORCHARD_AVX2 FourVectors absolute(const FourVectors& a) { return {absolute(a.x), absolute(a.y), absolute(a.z)}; }
ORCHARD_AVX2 FourVectors operator-(const FourVectors& a, const FourVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
ORCHARD_AVX2 FourVectors operator+(const FourVectors& a, const FourVectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
ORCHARD_AVX2 FourVectors cross(const FourVectors& a, const FourVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
ORCHARD_AVX2 __m256d dot(const FourVectors& a, const FourVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
ORCHARD_AVX2 __m256d squared(const FourVectors& a) { return dot(a, a); }
ORCHARD_AVX2 __m256d length(const FourVectors& a) { return _mm256_sqrt_pd(dot(a, a)); }

// Returns a bit for each lane in which a comparison holds.
ORCHARD_AVX2 unsigned lanes_of(__m256d holds) { return static_cast<unsigned>(_mm256_movemask_pd(holds)); }
ORCHARD_AVX2 unsigned lanes_equal(__m256i lanes, std::int64_t number) {
  return lanes_of(_mm256_castsi256_pd(_mm256_cmpeq_epi64(lanes, _mm256_set1_epi64x(number))));
}

// Transposes four vectors of four numbers.
ORCHARD_AVX2 void transpose(__m256d& a, __m256d& b, __m256d& c, __m256d& d) {
  const __m256d low_ab = _mm256_unpacklo_pd(a, b), high_ab = _mm256_unpackhi_pd(a, b);
  const __m256d low_cd = _mm256_unpacklo_pd(c, d), high_cd = _mm256_unpackhi_pd(c, d);
  a = _mm256_permute2f128_pd(low_ab, low_cd, 0x20);
  b = _mm256_permute2f128_pd(high_ab, high_cd, 0x20);
  c = _mm256_permute2f128_pd(low_ab, low_cd, 0x31);
  d = _mm256_permute2f128_pd(high_ab, high_cd, 0x31);
}

// Loads four points. Nothing is read beyond the three coordinates of a point.
ORCHARD_AVX2 FourVectors load_four(const std::array<const Point*, 4>& p) {
  const __m256i three = _mm256_set_epi64x(0, -1, -1, -1);
  __m256d a = _mm256_maskload_pd(p[0]->data(), three), b = _mm256_maskload_pd(p[1]->data(), three),
          c = _mm256_maskload_pd(p[2]->data(), three), d = _mm256_maskload_pd(p[3]->data(), three);
  transpose(a, b, c, d);
  return {a, b, c};
}

}  // namespace orchard::detail
#endif
