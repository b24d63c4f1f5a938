#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "predicates/vectors.h"
#include "workspace/workspace.h"

// The workspace's tests of a vertex, for four vertices at once.
namespace orchard::detail {

#ifdef ORCHARD_FOUR_LANES
ORCHARD_AVX2 __m256i Workspace::states(const std::array<Index, 4>& v) const {
  return _mm256_set_epi64x(state_[v[3]], state_[v[2]], state_[v[1]], state_[v[0]]);
}

// The same values as bounds_: powers of four, but infinity for the two classes without a bound.
ORCHARD_AVX2 __m256d Workspace::bounds(__m256i states) const {
  const __m256i error = _mm256_and_si256(_mm256_srli_epi64(states, 2), _mm256_set1_epi64x(63));
  const __m256i least = _mm256_set1_epi64x(std::bit_cast<std::int64_t>(bounds_[0]));
  return _mm256_blendv_pd(_mm256_castsi256_pd(_mm256_add_epi64(least, _mm256_slli_epi64(error, 53))),
                          all_four(std::numeric_limits<double>::infinity()),
                          _mm256_castsi256_pd(_mm256_cmpgt_epi64(error, _mm256_set1_epi64x(kNotSettled - 1))));
}

ORCHARD_AVX2 unsigned Workspace::agree_four(const std::array<Index, 4>& v, const std::array<Index, 4>& u,
                                            const FourVectors& q) const {
  FourVectors center;
  __m256d radius, *const rows[] = {&center.x, &center.y, &center.z, &radius};
  unsigned same = 0;
  for (unsigned i = 0; i < 4; ++i) {
    *rows[i] = _mm256_load_pd(vertices[v[i]].center.data());
    const __m256d other = _mm256_load_pd(vertices[u[i]].center.data());
    const bool equal = (lanes_of(_mm256_cmp_pd(*rows[i], other, _CMP_EQ_OQ)) & 7u) == 7u;
    same |= static_cast<unsigned>(equal & settled(u[i])) << i;
  }
  transpose(center.x, center.y, center.z, radius);
  const FourVectors from_q = center - q;
  const __m256i state = states(v);
  const __m256d power = radius - dot(from_q, from_q);
  const unsigned far = lanes_of(_mm256_cmp_pd(power, -bounds(state), _CMP_LT_OQ));
  const __m256i shared = _mm256_and_si256(_mm256_or_si256(state, states(u)), _mm256_set1_epi64x(kShared));
  return (far & lanes_equal(shared, 0)) | (exact_ ? 0 : same);
}

ORCHARD_AVX2 Workspace::FourSpheres Workspace::spheres(const std::array<Index, 4>& v) const {
  const __m256i state = states(v), shared = _mm256_set1_epi64x(kShared);
  const __m256d squared_radius =
      _mm256_set_pd(vertices[v[3]].radius, vertices[v[2]].radius, vertices[v[1]].radius, vertices[v[0]].radius);
  return {_mm256_sqrt_pd(squared_radius), bounds(state),
          _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(state, shared), shared))};
}

ORCHARD_AVX2 __m256d Workspace::own_power_bounds(const FourVectors& center, __m256d squared_radius, __m256d radius,
                                                 __m256d off) {
  const __m256d sum = absolute(center.x) + absolute(center.y) + absolute(center.z);
  return all_four(4) * off * radius + all_four(64 * kRounding) * (squared_radius + radius * sum);
}

ORCHARD_AVX2 Workspace::FourTests Workspace::test_four(const std::array<Index, 4>& v, const FourVectors& q,
                                                       double doubtful_input) const {
  const auto load = [&](Index u) { return vertices[u].center.data(); };  // the radius is behind it
  FourVectors center{_mm256_load_pd(load(v[0])), _mm256_load_pd(load(v[1])), _mm256_load_pd(load(v[2]))};
  __m256d radius = _mm256_load_pd(load(v[3]));
  transpose(center.x, center.y, center.z, radius);
  const FourVectors from_q = center - q;
  const __m256d power = radius - dot(from_q, from_q);
  const __m256i state = states(v);
  const __m256d bound = bounds(state);
  const __m256i mark = _mm256_and_si256(state, _mm256_set1_epi64x(3));
  return {{lanes_equal(mark, static_cast<int>(Mark::unseen)), lanes_equal(mark, static_cast<int>(Mark::kept))},
          lanes_of(_mm256_cmp_pd(power, -bound, _CMP_LT_OQ)),
          lanes_of(_mm256_cmp_pd(power, bound, _CMP_GT_OQ)),
          lanes_of(_mm256_cmp_pd(bound, all_four(doubtful_input) * radius, _CMP_LT_OQ))};
}
#endif

}  // namespace orchard::detail
