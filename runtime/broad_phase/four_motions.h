#pragma once
#include <cstddef>

#include "orchard/runtime/motion.h"
#include "simd/vector_support.h"

namespace orchard::runtime::detail {

#ifdef ORCHARD_VECTORS
// Four doubles as one value.
struct VectorDoubles {
  using Numbers __attribute__((vector_size(32))) = double;
  using Mask __attribute__((vector_size(32))) = std::int64_t;
  ORCHARD_INLINE static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return mask ? a : b;
  }
  ORCHARD_INLINE static Numbers min(const Numbers& a, const Numbers& b) noexcept { return choose(b < a, b, a); }
  ORCHARD_INLINE static Numbers max(const Numbers& a, const Numbers& b) noexcept { return choose(a < b, b, a); }
  ORCHARD_INLINE static Numbers abs(const Numbers& a) noexcept { return max(a, -a); }
  ORCHARD_INLINE static Numbers sqrt(const Numbers& a) noexcept {  // one instruction with -fno-math-errno
    Numbers result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = __builtin_sqrt(a[i]);
    return result;
  }
  ORCHARD_INLINE static bool all(const Mask& mask) noexcept { return (mask[0] & mask[1] & mask[2] & mask[3]) != 0; }
  ORCHARD_INLINE static bool any(const Mask& mask) noexcept { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }
  ORCHARD_INLINE static Numbers at(const double* from) noexcept {
    Numbers result;
    std::memcpy(&result, from, sizeof result);
    return result;
  }
  // Four numbers, from the one at `first` on, of each of four motions, transposed; which(i) points to the i-th one.
  template <typename Which>
  ORCHARD_INLINE static std::array<Numbers, 4> transposed(const Which& which, std::size_t first) noexcept {
    const auto row = [&](std::size_t i)
                         ORCHARD_INLINE_LAMBDA { return at(reinterpret_cast<const double*>(which(i)) + first); };
    const Numbers a = row(0), b = row(1), c = row(2), d = row(3);
    const Numbers ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Numbers cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab02, cd02, 0, 1, 4, 5), __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5),
            __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7), __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7)};
  }
};
// How many doubles lie before what transposed() reads in one go.
inline constexpr std::size_t kPositionAndVelocity = 0, kVelocityAndRadius = 4, kDriftAndHalfSpace = 8;
static_assert(offsetof(Motion, position) == 0 && offsetof(Motion, velocity) == 24 && offsetof(Motion, radius) == 48 &&
              offsetof(Motion, acceleration) == 56 && offsetof(Motion, drift) == 64 &&
              offsetof(Motion, half_space) == 72);
#endif

}  // namespace orchard::runtime::detail
