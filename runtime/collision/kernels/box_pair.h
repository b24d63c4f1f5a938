#pragma once
#include "collision/kernels/eight.h"
#include "collision/kernels/node_box.h"

// Eight nodes' boxes against one other's each: what gaps (node_box.cpp) and axes (front_block.cpp) of such are made of.
// Rounding: placed_trees.cpp, (6).
namespace orchard::runtime::detail {

template <typename Kind>
struct Boxes {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;

  Vectors center, n, m, l;
  Floats height, width, length, radius;

  ORCHARD_INLINE static Boxes of(const NodeBox& b) noexcept {
    const std::array<float, 3> third = third_normal(b);
    const auto all = [](const auto& v) ORCHARD_INLINE_LAMBDA -> Vectors {
      return {E::all(v[0]), E::all(v[1]), E::all(v[2])};
    };
    return {all(b.center),    all(b.n),        all(b.m),         all(third),
            E::all(b.height), E::all(b.width), E::all(b.length), E::all(b.radius)};
  }
  // `scale`: times this, lanes are in the other one's units.
  ORCHARD_INLINE static Boxes of(const ObbNodeBlock& b, float scale, std::uint32_t lane) noexcept {
    const Floats unit = E::all(scale);
    const Vectors n = {E::at(b.nx, lane), E::at(b.ny, lane), E::at(b.nz, lane)},
                  m = {E::at(b.mx, lane), E::at(b.my, lane), E::at(b.mz, lane)};
    return {{E::at(b.x, lane) * unit, E::at(b.y, lane) * unit, E::at(b.z, lane) * unit},
            n,
            m,
            E::cross(n, m),
            E::at(b.height, lane) * unit,
            E::at(b.width, lane) * unit,
            E::at(b.length, lane) * unit,
            E::at(b.radius, lane) * unit};
  }
};

// The gap along the best of the axes tried so far.
template <typename Kind>
struct BestGap {
  using E = Eight<Kind>;
  typename E::Floats gap;

  ORCHARD_INLINE void take(const typename E::Floats& other, const typename E::Vectors&,
                           const typename E::Floats&) noexcept {
    gap = E::max(gap, other);
  }
};

template <typename Kind>
struct BoxPair {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;

  const Boxes<Kind>&p, &q;
  Vectors d;        // from p's centre to q's
  Floats distance;  // of the centres
  Floats ball_gap;

  ORCHARD_INLINE BoxPair(const Boxes<Kind>& p_, const Boxes<Kind>& q_) noexcept
      : p(p_),
        q(q_),
        d(E::minus(q.center, p.center)),
        distance(Kind::sqrt(E::dot(d, d))),
        ball_gap(distance - (q.radius + p.radius)) {}

  // Tries the axes of both boxes and the line of the centres. Precondition: best has the balls' gap, along that line.
  template <typename Best>
  ORCHARD_INLINE void find(Best& best) const noexcept {
    const Floats signed_n = E::dot(d, q.n), signed_m = E::dot(d, q.m), signed_l = E::dot(d, q.l);
    const Floats over_n = E::abs(signed_n), over_m = E::abs(signed_m), over_l = E::abs(signed_l);
    Floats reach = q.height * over_n + q.width * over_m + q.length * over_l;
    Vectors across = {E::all(0.0f), E::all(0.0f), E::all(0.0f)};  // how far p reaches along q's axes
    const auto along = [&](const Vectors& u, const Floats& own) ORCHARD_INLINE_LAMBDA {
      const Floats by = E::dot(d, u), over = E::abs(by);
      const Floats un = E::abs(E::dot(u, q.n)), um = E::abs(E::dot(u, q.m)), ul = E::abs(E::dot(u, q.l));
      const Floats other = E::min(q.height * un + q.width * um + q.length * ul, q.radius);
      best.take(over - (own + other), u, by);
      reach = reach + own * over;
      across = {across.x + own * un, across.y + own * um, across.z + own * ul};
    };
    along(p.n, p.height), along(p.m, p.width), along(p.l, p.length);
    best.take(over_n - (q.height + E::min(across.x, p.radius)), q.n, signed_n);
    best.take(over_m - (q.width + E::min(across.y, p.radius)), q.m, signed_m);
    best.take(over_l - (q.length + E::min(across.z, p.radius)), q.l, signed_l);
    const Floats far = distance + E::all(kMinDistance);
    best.take(distance - reach / far, {d.x / far, d.y / far, d.z / far}, E::all(0.0f));
  }
};

}  // namespace orchard::runtime::detail
