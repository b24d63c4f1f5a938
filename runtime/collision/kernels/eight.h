#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"
#include "simd/vector_support.h"

// Operations on eight numbers, and on eight vectors, at a time. The inner loops over spheres, boxes and triangles
// consist of them. `Kind` is PlainFloats or a kind that uses the compiler's vectors (simd/vector_support.h).
namespace orchard::runtime::detail {

// The kinds for PerMachine (machine.h): one for the widest vectors that there are, one for those that every machine
// has.
#ifdef ORCHARD_VECTORS
using Widest = VectorFloats;
using Base = FourFloats;
#else
using Widest = PlainFloats;
using Base = PlainFloats;
#endif

inline constexpr float kMinDistance = 1e-18f;  // keeps a quotient finite; far below every margin

template <typename Kind>
struct Eight {
  using Floats = typename Kind::Floats;
  using Mask = typename Kind::Mask;
  struct Vectors {
    Floats x, y, z;
  };

  static constexpr std::uint32_t kAll = (1u << kBlockWidth) - 1;

  ORCHARD_INLINE static Floats at(const std::array<float, kBlockWidth>& from) noexcept { return load<Floats>(from); }
  ORCHARD_INLINE static Floats all(float value) noexcept { return spread<Floats>(value); }
  // min() and max() use a comparison each: then compilers recognise a minimum and a maximum, which are single
  // instructions. If an argument is not a number, both return the second one.
  ORCHARD_INLINE static Floats min(const Floats& a, const Floats& b) noexcept { return Kind::choose(a < b, a, b); }
  ORCHARD_INLINE static Floats max(const Floats& a, const Floats& b) noexcept { return Kind::choose(b < a, a, b); }
  ORCHARD_INLINE static Floats abs(const Floats& a) noexcept { return max(a, -a); }
  ORCHARD_INLINE static Floats dot(const Vectors& a, const Vectors& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  ORCHARD_INLINE static Vectors minus(const Vectors& a, const Vectors& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  ORCHARD_INLINE static Vectors cross(const Vectors& a, const Vectors& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  ORCHARD_INLINE static Floats one_norm(const Vectors& a) noexcept { return abs(a.x) + abs(a.y) + abs(a.z); }
  ORCHARD_INLINE static Vectors times(const Vectors& v, const Floats& s) noexcept {
    return {v.x * s, v.y * s, v.z * s};
  }
  ORCHARD_INLINE static Vectors turn(const std::array<float, 9>& r, const Vectors& v) noexcept {
    return {all(r[0]) * v.x + all(r[1]) * v.y + all(r[2]) * v.z, all(r[3]) * v.x + all(r[4]) * v.y + all(r[5]) * v.z,
            all(r[6]) * v.x + all(r[7]) * v.y + all(r[8]) * v.z};
  }
  ORCHARD_INLINE static Vectors move(const Placement& p, const Vectors& v) noexcept {
    const Vectors turned = turn(p.rotation, v);
    return {turned.x + all(p.translation[0]), turned.y + all(p.translation[1]), turned.z + all(p.translation[2])};
  }
  template <typename V>
  ORCHARD_INLINE static Vectors all_of(const V& v) noexcept {
    return {all(v[0]), all(v[1]), all(v[2])};
  }
  ORCHARD_INLINE static Vectors corner(const TriangleBlock& block, std::size_t k) noexcept {
    return {at(block.corner[k][0]), at(block.corner[k][1]), at(block.corner[k][2])};
  }
};

// Eight vectors that were computed together, for use one by one.
template <typename Kind>
struct OneByOne {
  using E = Eight<Kind>;
  std::array<float, kBlockWidth> x, y, z;

  ORCHARD_INLINE explicit OneByOne(const typename E::Vectors& v) noexcept {
    store(v.x, x), store(v.y, y), store(v.z, z);
  }
  ORCHARD_INLINE typename E::Vectors operator[](std::size_t i) const noexcept {
    return {E::all(x[i]), E::all(y[i]), E::all(z[i])};
  }
};

// Returns the least of eight numbers.
template <typename Kind>
ORCHARD_INLINE float least_of(const typename Kind::Floats& v) noexcept {
  std::array<float, kBlockWidth> lanes;
  store(v, lanes);
  for (std::uint32_t half = kBlockWidth / 2; half > 0; half /= 2) {
    for (std::uint32_t i = 0; i < half; ++i) lanes[i] = lanes[i + half] < lanes[i] ? lanes[i + half] : lanes[i];
  }
  return lanes[0];
}

// Which of eight distances are at most `limit`, rounded to float, as bits, and the least of the others.
struct Within {
  std::uint32_t lanes;
  float beyond;
};
ORCHARD_INLINE Within within(const std::array<float, kBlockWidth>& distances, double limit) noexcept {
  using E = Eight<Base>;
  const E::Floats distance = E::at(distances), infinite = E::all(std::numeric_limits<float>::infinity());
  const auto outside = E::all(static_cast<float>(limit)) < distance;
  return {~Base::bits(outside) & E::kAll, least_of<Base>(Base::choose(outside, distance, infinite))};
}

// Returns the lanes that hold a triangle, as bits.
ORCHARD_INLINE std::uint32_t used_lanes(const TriangleBlock& block) noexcept {
  std::uint32_t used = 0;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) used |= std::uint32_t{block.triangle[i] != kNoTriangle} << i;
  return used;
}

}  // namespace orchard::runtime::detail
