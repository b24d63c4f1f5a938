#pragma once
#include "eight.h"

// One ball slab against eight: what the axes (front_block.cpp) and the times (ball_slab_time.cpp) of such are made of.
namespace orchard::runtime::detail {

// Added to the square of a sine before its root: a cosine of two float normals is good to some 50 u, u = 2^-24.
inline constexpr float kSineError = 0x1p-17f;

template <typename Kind>
struct BallSlabPair {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;

  Vectors c, n, place, m;      // centres and normals: of the lanes, and of the single one
  Floats r, h, s, k;           // radii and heights, likewise
  Vectors d;                   // from the single one's centre to the lanes'
  Floats over_n, over_m;       // of d along the normals
  Floats distance;             // of the centres
  Floats by_n, by_m, by_line;  // gaps along both normals; along the line of the centres, or between the balls

  // `placement` moves the lanes unless it is null. The lanes as they are tested go to `result`. `lane`: which one,
  // where Kind is of one.
  template <typename Result>
  ORCHARD_INLINE BallSlabPair(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement,
                              Result& result, std::uint32_t lane = 0) noexcept
      : c{E::at(lanes.x, lane), E::at(lanes.y, lane), E::at(lanes.z, lane)},
        n{E::at(lanes.nx, lane), E::at(lanes.ny, lane), E::at(lanes.nz, lane)},
        place{E::all(single.x), E::all(single.y), E::all(single.z)},
        m{E::all(single.nx), E::all(single.ny), E::all(single.nz)},
        r(E::at(lanes.radius, lane)),
        h(E::at(lanes.height, lane)),
        s(E::all(single.radius)),
        k(E::all(single.height)) {
    place_lanes(placement, result, lane);
  }

 private:
  template <typename Result>
  ORCHARD_INLINE void place_lanes(const Placement* placement, Result& result, std::uint32_t lane) noexcept {
    result.used = Kind::bits(E::all(0.0f) <= r);
    if (placement != nullptr) {
      c = E::move(*placement, c);
      n = E::turn(placement->turn, n);
      r = r * E::all(placement->scale);
      h = h * E::all(placement->scale);
    }
    E::put(c.x, result.x, lane), E::put(c.y, result.y, lane), E::put(c.z, result.z, lane);
    E::put(n.x, result.nx, lane), E::put(n.y, result.ny, lane), E::put(n.z, result.nz, lane);
    E::put(r, result.radius, lane), E::put(h, result.height, lane);
    find_gaps();
  }

  // How far each reaches along a unit vector: across the planes, height times the cosine; along them, at most the
  // radius times the sine. The axes tried: both normals, the line of the centres, and the balls.
  ORCHARD_INLINE void find_gaps() noexcept {
    const Floats zero = E::all(0.0f), slack = E::all(kSineError);
    d = E::minus(c, place);
    over_n = E::dot(d, n), over_m = E::dot(d, m);
    const Floats square = E::dot(d, d), along_n = E::size(over_n), along_m = E::size(over_m);
    const Floats cosine = E::size(E::dot(n, m));
    const Floats sine = Kind::root(E::larger(E::all(1.0f) - cosine * cosine, zero) + slack);
    distance = Kind::root(square);
    const Floats slope = square * slack;
    const Floats across_n = Kind::root(E::larger(square - along_n * along_n, zero) + slope);
    const Floats across_m = Kind::root(E::larger(square - along_m * along_m, zero) + slope);
    by_n = along_n - (h + (k * cosine + s * sine));
    by_m = along_m - (k + (h * cosine + r * sine));
    const Floats reach = (h * along_n + r * across_n) + (k * along_m + s * across_m);
    by_line = E::larger(distance - reach / (distance + E::all(kMinDistance)), distance - (r + s));
  }
};

}  // namespace orchard::runtime::detail
