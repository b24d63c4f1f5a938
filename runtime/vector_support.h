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
  static Floats root(const Floats& a) noexcept {
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
  ORCHARD_INLINE static Floats root(const Floats& a) noexcept {  // one instruction with -fno-math-errno
    Floats result;
    for (std::size_t i = 0; i < 8; ++i) result[i] = __builtin_sqrtf(a[i]);
    return result;
  }
  ORCHARD_INLINE static std::uint32_t bits(const Mask& mask) noexcept {
    using Bytes __attribute__((vector_size(8))) = std::uint8_t;
    const Bytes narrow = __builtin_convertvector(mask & 1, Bytes);
    std::uint64_t bytes;
    std::memcpy(&bytes, &narrow, sizeof bytes);
    return static_cast<std::uint32_t>((bytes * 0x0102040810204080u) >> 56);
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
  std::array<T, sizeof(Vector) / sizeof(T)> copies;
  for (T& copy : copies) copy = value;
  return load<Vector>(copies);
}

}  // namespace orchard::runtime::detail
