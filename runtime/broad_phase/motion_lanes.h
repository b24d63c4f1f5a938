#pragma once
#include <cmath>
#include <cstddef>

#include "orchard/runtime/motion.h"
#include "simd/machine.h"

// The inner loops are compiled for two kinds of numbers: OneDouble handles one body at a time, and FourDoubles handles
// four, with a vector for each coordinate. Both give the same bits.
namespace orchard::runtime::detail {

template <typename Number>
struct MotionLanes {
  using Three = std::array<Number, 3>;
  Three position, velocity, half_space;
  Number radius, acceleration, drift;
};

// One body at a time.
struct OneDouble {
  using Numbers = double;
  using Mask = bool;
  static constexpr std::size_t kLanes = 1;
  static double choose(bool mask, double a, double b) noexcept { return mask ? a : b; }
  static double sqrt(double a) noexcept { return std::sqrt(a); }
  static bool all(bool mask) noexcept { return mask; }
  static bool any(bool mask) noexcept { return mask; }
  static std::uint32_t bits(bool mask) noexcept { return mask ? 1 : 0; }
  static void truncate(double a, std::uint32_t* to) noexcept {
    *to = static_cast<std::uint32_t>(static_cast<std::int32_t>(a));
  }
  template <typename Which>
  static MotionLanes<double> motions(const Which& which) noexcept {
    const Motion& m = *which(0);
    const auto three = [](const Vec3& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
    return {three(m.position), three(m.velocity), three(m.half_space), m.radius, m.acceleration, m.drift};
  }
};

#ifdef ORCHARD_VECTORS
// Four bodies at a time.
struct FourDoubles {
  using Numbers __attribute__((vector_size(32))) = double;
  using Mask __attribute__((vector_size(32))) = std::int64_t;
  static constexpr std::size_t kLanes = 4;
  ORCHARD_INLINE static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return mask ? a : b;
  }
  ORCHARD_INLINE static Numbers sqrt(const Numbers& a) noexcept {  // one instruction with -fno-math-errno
    Numbers result;
    for (std::size_t i = 0; i < 4; ++i) result[i] = __builtin_sqrt(a[i]);
    return result;
  }
  ORCHARD_INLINE static bool all(const Mask& mask) noexcept { return (mask[0] & mask[1] & mask[2] & mask[3]) != 0; }
  ORCHARD_INLINE static bool any(const Mask& mask) noexcept { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }
  ORCHARD_INLINE static std::uint32_t bits(const Mask& mask) noexcept {
    const Mask met = mask & Mask{1, 2, 4, 8};
    return static_cast<std::uint32_t>((met[0] | met[1]) | (met[2] | met[3]));
  }
  ORCHARD_INLINE static void truncate(const Numbers& a, std::uint32_t* to) noexcept {
    using Integers __attribute__((vector_size(16))) = std::int32_t;
    const Integers integers = __builtin_convertvector(a, Integers);
    std::memcpy(to, &integers, sizeof integers);
  }
  // which(i) points to the i-th motion.
  template <typename Which>
  ORCHARD_INLINE static MotionLanes<Numbers> motions(const Which& which) noexcept {
    static_assert(offsetof(Motion, position) == 0 && offsetof(Motion, velocity) == 24 &&
                  offsetof(Motion, radius) == 48 && offsetof(Motion, acceleration) == 56 &&
                  offsetof(Motion, drift) == 64 && offsetof(Motion, half_space) == 72);
    const auto first = transposed(which, 0), second = transposed(which, 4), third = transposed(which, 8);
    return {{first[0], first[1], first[2]},
            {first[3], second[0], second[1]},
            {third[1], third[2], third[3]},
            second[2],
            second[3],
            third[0]};
  }

 private:
  // Returns the numbers from `from` to from + 3 of four motions: result[k] has the number from + k of each motion.
  template <typename Which>
  ORCHARD_INLINE static std::array<Numbers, 4> transposed(const Which& which, std::size_t from) noexcept {
    const auto row = [&](std::size_t i) ORCHARD_INLINE_LAMBDA {
      Numbers result;
      std::memcpy(&result, reinterpret_cast<const double*>(which(i)) + from, sizeof result);
      return result;
    };
    const Numbers a = row(0), b = row(1), c = row(2), d = row(3);
    const Numbers ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Numbers cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab02, cd02, 0, 1, 4, 5), __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5),
            __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7), __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7)};
  }
};
#endif

// Calls work.template operator()<Kind>() with the kind that suits the machine. On a machine without wide vectors that
// is OneDouble, because there a choice among vectors of four numbers takes longer than four choices.
template <typename Work>
void with_best_lanes(const Work& work) {
#ifdef ORCHARD_VECTORS
#ifdef ORCHARD_MACHINES
  constexpr Machine kLeast = Machine::avx2;
#else
  constexpr Machine kLeast = Machine::base;
#endif
  if (machine() >= kLeast) {
    return per_machine([&]() ORCHARD_INLINE_LAMBDA { work.template operator()<FourDoubles>(); });
  }
#endif
  work.template operator()<OneDouble>();
}

template <typename Kind>
ORCHARD_INLINE typename Kind::Numbers load_lanes(const double* from) noexcept {
  typename Kind::Numbers result;
  std::memcpy(&result, from, sizeof result);
  return result;
}
template <typename Kind>
ORCHARD_INLINE typename Kind::Numbers all_of(double x) noexcept {
  return spread<typename Kind::Numbers>(x);
}
template <typename Kind, typename Numbers>
ORCHARD_INLINE Numbers least(const Numbers& a, const Numbers& b) noexcept {
  return Kind::choose(b < a, b, a);
}
template <typename Kind, typename Numbers>
ORCHARD_INLINE Numbers most(const Numbers& a, const Numbers& b) noexcept {
  return Kind::choose(a < b, b, a);
}
template <typename Mask, typename Other>
ORCHARD_INLINE Mask both(const Mask& a, const Other& b) noexcept {
  return a & b;
}
template <typename Three>
ORCHARD_INLINE auto dot_of(const Three& a, const Three& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Returns whether the motions are valid, like is_valid(), but without looking at the expiry and with one sum for all
// numbers. So it may be false for a valid motion, but never true for one with NaN.
template <typename Kind>
ORCHARD_INLINE typename Kind::Mask are_valid(const MotionLanes<typename Kind::Numbers>& m) noexcept {
  const auto squares = dot_of(m.position, m.position) + dot_of(m.velocity, m.velocity) +
                       dot_of(m.half_space, m.half_space) +
                       (m.radius * m.radius + m.acceleration * m.acceleration + m.drift * m.drift);
  const auto lowest = least<Kind>(least<Kind>(m.radius, m.acceleration), m.drift);
  return both(squares <= all_of<Kind>(kMaxNumber * kMaxNumber), all_of<Kind>(0) <= lowest);
}

}  // namespace orchard::runtime::detail
