#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

// With GCC and Clang, several numbers are one value (vector_size), which the compiler maps to the vectors of the
// target: SSE, AVX, NEON. For x86-64, the inner loops are also compiled for AVX2 and AVX-512 (machine.h). With
// ORCHARD_NO_VECTORS, and for other compilers, they process one number at a time.
#if defined(__GNUC__) && !defined(ORCHARD_NO_VECTORS)
#define ORCHARD_VECTORS 1
#define ORCHARD_INLINE [[gnu::always_inline]] inline
#define ORCHARD_INLINE_LAMBDA __attribute__((always_inline))
#pragma GCC diagnostic ignored "-Wpsabi"  // no vector crosses a call
#ifdef __SSE2__
#include <emmintrin.h>
#endif
#else
#define ORCHARD_INLINE inline
#define ORCHARD_INLINE_LAMBDA
#endif

namespace orchard::runtime::detail {

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

// Returns the result of a comparison of two numbers or of two vectors: all ones, or zero.
template <typename Part, typename Holds>
ORCHARD_INLINE auto compared(const Part& a, const Part& b, const Holds& holds) noexcept {
  if constexpr (std::is_arithmetic_v<Part>) {
    using Word = std::conditional_t<sizeof(Part) == 4, std::uint32_t, std::uint64_t>;
    return holds(a, b) ? ~Word{} : Word{};
  } else {
    return holds(a, b);
  }
}

// N numbers, or N vectors of a width that every machine has, with the operators of a single vector of all of them.
template <typename Part, std::size_t N>
struct Several {
  Part part[N];

  template <typename F>
  ORCHARD_INLINE static Several make(const F& of) noexcept {
    Several result;
    for (std::size_t i = 0; i < N; ++i) result.part[i] = of(i);
    return result;
  }
  ORCHARD_INLINE Part operator[](std::size_t i) const noexcept { return part[i]; }
  ORCHARD_INLINE Several operator-() const noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return -part[i]; });
  }
  ORCHARD_INLINE friend Several operator+(const Several& a, const Several& b) noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return a[i] + b[i]; });
  }
  ORCHARD_INLINE friend Several operator-(const Several& a, const Several& b) noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return a[i] - b[i]; });
  }
  ORCHARD_INLINE friend Several operator*(const Several& a, const Several& b) noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return a[i] * b[i]; });
  }
  ORCHARD_INLINE friend Several operator/(const Several& a, const Several& b) noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return a[i] / b[i]; });
  }
  ORCHARD_INLINE friend Several operator&(const Several& a, const Several& b) noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return a[i] & b[i]; });
  }
  ORCHARD_INLINE friend Several operator|(const Several& a, const Several& b) noexcept {
    return make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return a[i] | b[i]; });
  }
  ORCHARD_INLINE friend auto operator<(const Several& a, const Several& b) noexcept {
    return compare(a, b, [](const Part& x, const Part& y) ORCHARD_INLINE_LAMBDA { return x < y; });
  }
  ORCHARD_INLINE friend auto operator<=(const Several& a, const Several& b) noexcept {
    return compare(a, b, [](const Part& x, const Part& y) ORCHARD_INLINE_LAMBDA { return x <= y; });
  }

 private:
  template <typename Holds>
  ORCHARD_INLINE static auto compare(const Several& a, const Several& b, const Holds& holds) noexcept {
    using Mask = Several<decltype(compared(a[0], b[0], holds)), N>;
    return Mask::make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return compared(a[i], b[i], holds); });
  }
};

ORCHARD_INLINE float root_of(float a) noexcept { return std::sqrt(a); }
ORCHARD_INLINE std::uint32_t bits_of(std::uint32_t mask) noexcept { return mask & 1u; }

#ifdef ORCHARD_VECTORS
using Quad __attribute__((vector_size(16))) = float;
using QuadMask __attribute__((vector_size(16))) = std::int32_t;
ORCHARD_INLINE Quad root_of(const Quad& a) noexcept {
#ifdef __SSE2__
  return _mm_sqrt_ps(a);
#else
  return Quad{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]), __builtin_sqrtf(a[3])};
#endif
}
ORCHARD_INLINE std::uint32_t bits_of(const QuadMask& mask) noexcept {
#ifdef __SSE2__
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<Quad>(mask)));
#else
  return (static_cast<std::uint32_t>(mask[0]) & 1u) | (static_cast<std::uint32_t>(mask[1]) & 2u) |
         (static_cast<std::uint32_t>(mask[2]) & 4u) | (static_cast<std::uint32_t>(mask[3]) & 8u);
#endif
}
#endif

// The kinds of eight floats for which the inner loops are compiled. All give the same bits.
template <typename Part>
struct SeveralFloats {
  static constexpr std::size_t kParts = 8 * sizeof(float) / sizeof(Part);
  using Floats = Several<Part, kParts>;
  using Mask = decltype(Floats{} < Floats{});
  ORCHARD_INLINE static Floats choose(const Mask& mask, const Floats& a, const Floats& b) noexcept {
    return Floats::make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return mask[i] ? a[i] : b[i]; });
  }
  ORCHARD_INLINE static Floats sqrt(const Floats& a) noexcept {
    return Floats::make([&](std::size_t i) ORCHARD_INLINE_LAMBDA { return root_of(a[i]); });
  }
  ORCHARD_INLINE static std::uint32_t bits(const Mask& mask) noexcept {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < kParts; ++i) result |= bits_of(mask[i]) << (8 / kParts * i);
    return result;
  }
};
using PlainFloats = SeveralFloats<float>;
#ifdef ORCHARD_VECTORS
// For machines without wider vectors. Compilers split vectors of eight there, but process comparisons and choices of
// them one number at a time.
using FourFloats = SeveralFloats<Quad>;
#endif

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
  ORCHARD_INLINE static std::uint32_t bits(const Mask& mask) noexcept {
#if __has_builtin(__builtin_shufflevector)  // signs of four are one instruction everywhere
    return bits_of(__builtin_shufflevector(mask, mask, 0, 1, 2, 3)) |
           bits_of(__builtin_shufflevector(mask, mask, 4, 5, 6, 7)) << 4;
#else
    return FourFloats::bits(load<FourFloats::Mask>(mask));
#endif
  }
};
#endif

template <typename Vector, typename T>
ORCHARD_INLINE Vector spread(T value) noexcept {
  if constexpr (requires(Vector v) { v.part; }) {
    return Vector::make([&](std::size_t) ORCHARD_INLINE_LAMBDA { return spread<decltype(Vector{}[0])>(value); });
  } else if constexpr (std::is_arithmetic_v<Vector>) {
    return value;
  } else if constexpr (sizeof(Vector) == 4 * sizeof(T)) {
    return Vector{value, value, value, value};  // compilers make one instruction of this, but not of copies
  } else {
    std::array<T, sizeof(Vector) / sizeof(T)> copies;  // NOLINT(bugprone-sizeof-expression): vectors are no pointers
    for (T& copy : copies) copy = value;
    return load<Vector>(copies);
  }
}

}  // namespace orchard::runtime::detail
