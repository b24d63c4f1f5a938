#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

// With GCC and Clang several numbers are one value (vector_size), which the compiler maps to what the target has: SSE,
// AVX, NEON. For x86-64 the inner loops are compiled for AVX2 and AVX-512 as well: machine.h.
// ORCHARD_NO_VECTORS: one number at a time, as other compilers do it.
#if defined(__GNUC__) && !defined(ORCHARD_NO_VECTORS)
#define ORCHARD_VECTORS 1
#define ORCHARD_INLINE [[gnu::always_inline]] inline
#define ORCHARD_INLINE_LAMBDA __attribute__((always_inline))
#pragma GCC diagnostic ignored "-Wpsabi"  // no vector crosses a call
#ifdef __SSE2__
#include <emmintrin.h>
#if __has_builtin(__builtin_shufflevector)
#define ORCHARD_SIGNS_OF_HALVES 1  // signs of four are one instruction everywhere
#endif
#endif
#else
#define ORCHARD_INLINE inline
#define ORCHARD_INLINE_LAMBDA
#endif

namespace orchard::runtime::detail {

// N numbers with the operators that vectors have, one number at a time. Comparisons give all ones or zero.
template <typename T, std::size_t N>
struct Plain {
  using Mask = Plain<std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>, N>;
  std::array<T, N> v;

  template <typename F>
  static Plain make(F&& element) noexcept {
    Plain result;
    for (std::size_t i = 0; i < N; ++i) result.v[i] = element(i);
    return result;
  }
  template <typename F>
  static Mask compare(F&& holds) noexcept {
    return Mask::make([&](std::size_t i) { return holds(i) ? ~typename Mask::Number{} : typename Mask::Number{}; });
  }
  using Number = T;
  T operator[](std::size_t i) const noexcept { return v[i]; }
  Plain operator-() const noexcept {
    return make([&](std::size_t i) { return -v[i]; });
  }
  friend Plain operator+(const Plain& a, const Plain& b) noexcept {
    return make([&](std::size_t i) { return a[i] + b[i]; });
  }
  friend Plain operator-(const Plain& a, const Plain& b) noexcept {
    return make([&](std::size_t i) { return a[i] - b[i]; });
  }
  friend Plain operator*(const Plain& a, const Plain& b) noexcept {
    return make([&](std::size_t i) { return a[i] * b[i]; });
  }
  friend Plain operator/(const Plain& a, const Plain& b) noexcept {
    return make([&](std::size_t i) { return a[i] / b[i]; });
  }
  friend Plain operator&(const Plain& a, const Plain& b) noexcept {
    return make([&](std::size_t i) { return a[i] & b[i]; });
  }
  friend Plain operator|(const Plain& a, const Plain& b) noexcept {
    return make([&](std::size_t i) { return a[i] | b[i]; });
  }
  friend Mask operator<(const Plain& a, const Plain& b) noexcept {
    return compare([&](std::size_t i) { return a[i] < b[i]; });
  }
  friend Mask operator<=(const Plain& a, const Plain& b) noexcept {
    return compare([&](std::size_t i) { return a[i] <= b[i]; });
  }
};

// Eight floats at a time: the kinds that the inner loops are compiled for. Both give the same bits.
struct PlainFloats {
  using Floats = Plain<float, 8>;
  using Mask = Floats::Mask;
  static Floats choose(const Mask& mask, const Floats& a, const Floats& b) noexcept {
    return Floats::make([&](std::size_t i) { return mask[i] ? a[i] : b[i]; });
  }
  static Floats sqrt(const Floats& a) noexcept {
    return Floats::make([&](std::size_t i) { return std::sqrt(a[i]); });
  }
  static std::uint32_t bits(const Mask& mask) noexcept {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 8; ++i) result |= (mask[i] & 1u) << i;
    return result;
  }
};

#ifdef ORCHARD_VECTORS
struct VectorFloats {
  using Floats __attribute__((vector_size(32))) = float;
  using Mask __attribute__((vector_size(32))) = std::int32_t;
  ORCHARD_INLINE static Floats choose(const Mask& mask, const Floats& a, const Floats& b) noexcept {
    return mask ? a : b;
  }
  ORCHARD_INLINE static Floats sqrt(const Floats& a) noexcept {  // one instruction with -fno-math-errno
    Floats result;
    for (std::size_t i = 0; i < 8; ++i) result[i] = __builtin_sqrtf(a[i]);
    return result;
  }
#ifdef ORCHARD_SIGNS_OF_HALVES
  // The least of eight, halves against halves, as least_of() does it elsewhere.
  ORCHARD_INLINE static float min(const Floats& a) noexcept {
    const auto min_of = [](const auto& p, const auto& q) ORCHARD_INLINE_LAMBDA { return q < p ? q : p; };
    const auto four = min_of(__builtin_shufflevector(a, a, 0, 1, 2, 3), __builtin_shufflevector(a, a, 4, 5, 6, 7));
    const auto two = min_of(four, __builtin_shufflevector(four, four, 2, 3, 2, 3));
    return min_of(two, __builtin_shufflevector(two, two, 1, 1, 1, 1))[0];
  }
#endif
  ORCHARD_INLINE static std::uint32_t bits(const Mask& mask) noexcept {
#ifdef ORCHARD_SIGNS_OF_HALVES
    const auto half = [](const auto& v) ORCHARD_INLINE_LAMBDA {
      return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(v)));
    };
    return half(__builtin_shufflevector(mask, mask, 0, 1, 2, 3)) | half(__builtin_shufflevector(mask, mask, 4, 5, 6, 7))
                                                                       << 4;
#else
    using Bytes __attribute__((vector_size(8))) = std::uint8_t;
    const Bytes narrow = __builtin_convertvector(mask & 1, Bytes);
    std::uint64_t bytes;
    std::memcpy(&bytes, &narrow, sizeof bytes);
    return static_cast<std::uint32_t>((bytes * 0x0102040810204080u) >> 56);
#endif
  }
};
#endif

#ifdef ORCHARD_VECTORS
// The same as two vectors of four, for machines that have no wider ones: compilers split vectors of eight there, but
// comparisons and choices of them one number at a time.
struct FourFloats {
  using Four __attribute__((vector_size(16))) = float;
  using FourMask __attribute__((vector_size(16))) = std::int32_t;
  struct Mask {
    FourMask low, high;
    ORCHARD_INLINE friend Mask operator|(const Mask& a, const Mask& b) noexcept {
      return {a.low | b.low, a.high | b.high};
    }
    ORCHARD_INLINE friend Mask operator&(const Mask& a, const Mask& b) noexcept {
      return {a.low & b.low, a.high & b.high};
    }
  };
  struct Floats {
    Four low, high;
    ORCHARD_INLINE Floats operator-() const noexcept { return {-low, -high}; }
    ORCHARD_INLINE friend Floats operator+(const Floats& a, const Floats& b) noexcept {
      return {a.low + b.low, a.high + b.high};
    }
    ORCHARD_INLINE friend Floats operator-(const Floats& a, const Floats& b) noexcept {
      return {a.low - b.low, a.high - b.high};
    }
    ORCHARD_INLINE friend Floats operator*(const Floats& a, const Floats& b) noexcept {
      return {a.low * b.low, a.high * b.high};
    }
    ORCHARD_INLINE friend Floats operator/(const Floats& a, const Floats& b) noexcept {
      return {a.low / b.low, a.high / b.high};
    }
    ORCHARD_INLINE friend Mask operator<(const Floats& a, const Floats& b) noexcept {
      return {a.low < b.low, a.high < b.high};
    }
    ORCHARD_INLINE friend Mask operator<=(const Floats& a, const Floats& b) noexcept {
      return {a.low <= b.low, a.high <= b.high};
    }
  };
  ORCHARD_INLINE static Floats choose(const Mask& mask, const Floats& a, const Floats& b) noexcept {
    return {mask.low ? a.low : b.low, mask.high ? a.high : b.high};
  }
  ORCHARD_INLINE static Four root_of(const Four& a) noexcept {
#ifdef __SSE2__
    return _mm_sqrt_ps(a);
#else
    return Four{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]), __builtin_sqrtf(a[3])};
#endif
  }
  ORCHARD_INLINE static Floats sqrt(const Floats& a) noexcept { return {root_of(a.low), root_of(a.high)}; }
  ORCHARD_INLINE static std::uint32_t bits_of(const FourMask& mask) noexcept {
#ifdef __SSE2__
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<Four>(mask)));
#else
    return (static_cast<std::uint32_t>(mask[0]) & 1u) | (static_cast<std::uint32_t>(mask[1]) & 2u) |
           (static_cast<std::uint32_t>(mask[2]) & 4u) | (static_cast<std::uint32_t>(mask[3]) & 8u);
#endif
  }
  ORCHARD_INLINE static std::uint32_t bits(const Mask& mask) noexcept {
    return bits_of(mask.low) | bits_of(mask.high) << 4;
  }
};
#endif

template <typename Vector, typename Array>
ORCHARD_INLINE Vector load(const Array& from) noexcept {
  static_assert(sizeof(Vector) == sizeof(Array));
  Vector result;
  std::memcpy(&result, &from, sizeof result);
  return result;
}

template <typename Vector, typename Array>
ORCHARD_INLINE void store(const Vector& from, Array& to) noexcept {
  static_assert(sizeof(Vector) == sizeof(Array));
  std::memcpy(&to, &from, sizeof from);
}

template <typename Vector, typename T>
ORCHARD_INLINE Vector spread(T value) noexcept {
  if constexpr (requires(Vector v) { v.low; }) {  // of which compilers make one instruction, not of the copies
    const decltype(Vector::low) half = {value, value, value, value};
    return {half, half};
  }
  std::array<T, sizeof(Vector) / sizeof(T)> copies;  // NOLINT(bugprone-sizeof-expression): vectors are no pointers
  for (T& copy : copies) copy = value;
  return load<Vector>(copies);
}

}  // namespace orchard::runtime::detail
