#pragma once
#include "collision/kernels/eight.h"

// One ball slab against eight: what their times (obb_node_time.cpp) are made of.
namespace orchard::runtime::detail {

// Added to the square of a sine before its root: a cosine of two float normals is good to some 50 u, u = 2^-24.
inline constexpr float kSineError = 0x1p-17f;

template <typename Kind>
struct ObbNodePair {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;

  Vectors c, n, place, m;      // centres and normals: of the lanes, and of the single one
  Floats r, h, s, k;           // radii and heights, likewise
  Vectors d;                   // from the single one's centre to the lanes'
  Floats over_n, over_m;       // of d along the normals
  Floats distance;             // of the centres
  Floats by_n, by_m, by_line;  // gaps along both normals; along the line of the centres, or between the balls

  // `placement` moves the lanes unless it is null. The lanes as they are tested go to `result`.
  template <typename Result>
  ORCHARD_INLINE ObbNodePair(const ObbNode& single, const ObbNodeBlock& lanes, const Placement* placement,
                             Result& result) noexcept
      : c{load<Floats>(lanes.x), load<Floats>(lanes.y), load<Floats>(lanes.z)},
        n{load<Floats>(lanes.nx), load<Floats>(lanes.ny), load<Floats>(lanes.nz)},
        place{E::all(single.x), E::all(single.y), E::all(single.z)},
        m{E::all(single.nx), E::all(single.ny), E::all(single.nz)},
        r(load<Floats>(lanes.radius)),
        h(load<Floats>(lanes.height)),
        s(E::all(single.radius)),
        k(E::all(single.height)) {
    result.used = Kind::bits(E::all(0.0f) <= r);
    if (placement != nullptr) {
      c = E::move(*placement, c);
      n = E::turn(placement->turn, n);
      r = r * E::all(placement->scale);
      h = h * E::all(placement->scale);
    }
    store(c.x, result.x), store(c.y, result.y), store(c.z, result.z);
    store(n.x, result.nx), store(n.y, result.ny), store(n.z, result.nz);
    store(r, result.radius), store(h, result.height);
    find_gaps();
  }

 private:
  // How far each reaches along a unit vector: across the planes, height times the cosine; along them, at most the
  // radius times the sine. The axes tried: both normals, the line of the centres, and the balls.
  ORCHARD_INLINE void find_gaps() noexcept {
    const Floats zero = E::all(0.0f), slack = E::all(kSineError);
    d = E::minus(c, place);
    over_n = E::dot(d, n), over_m = E::dot(d, m);
    const Floats square = E::dot(d, d), along_n = E::abs(over_n), along_m = E::abs(over_m);
    const Floats cosine = E::abs(E::dot(n, m));
    const Floats sine = Kind::sqrt(E::max(E::all(1.0f) - cosine * cosine, zero) + slack);
    distance = Kind::sqrt(square);
    const Floats slope = square * slack;
    const Floats across_n = Kind::sqrt(E::max(square - along_n * along_n, zero) + slope);
    const Floats across_m = Kind::sqrt(E::max(square - along_m * along_m, zero) + slope);
    by_n = along_n - (h + (k * cosine + s * sine));
    by_m = along_m - (k + (h * cosine + r * sine));
    const Floats reach = (h * along_n + r * across_n) + (k * along_m + s * across_m);
    by_line = E::max(distance - reach / (distance + E::all(kMinDistance)), distance - (r + s));
  }
};

}  // namespace orchard::runtime::detail
