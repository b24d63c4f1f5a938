#pragma once
#include "collision/kernels/eight.h"
#include "collision/kernels/node_box.h"

// The ball and the box of one node against those of eight others: the axes along which they may be apart. Gaps
// (node_box.cpp) and times (box_time.cpp) are computed from these. The rounding is analysed in placed_trees.cpp, (6).
namespace orchard::runtime::detail {

// Eight boxes, or one box eight times.
template <typename Kind>
struct Boxes {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;

  Vectors center, n, m, l;
  Floats height, width, length, radius;

  ORCHARD_INLINE static Boxes of(const NodeBox& b) noexcept {
    return {E::all_of(b.center), E::all_of(b.n),  E::all_of(b.m),   E::all_of(third_normal(b)),
            E::all(b.height),    E::all(b.width), E::all(b.length), E::all(b.radius)};
  }
  // `scale` converts lengths of `b` to the units of the other box.
  ORCHARD_INLINE static Boxes of(const ObbNodeBlock& b, float scale) noexcept {
    const Floats unit = E::all(scale);
    const Vectors n = {E::at(b.nx), E::at(b.ny), E::at(b.nz)}, m = {E::at(b.mx), E::at(b.my), E::at(b.mz)};
    return {E::times({E::at(b.x), E::at(b.y), E::at(b.z)}, unit),
            n,
            m,
            E::cross(n, m),
            E::at(b.height) * unit,
            E::at(b.width) * unit,
            E::at(b.length) * unit,
            E::at(b.radius) * unit};
  }
};

// Eight pairs of boxes.
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

  ORCHARD_INLINE Vectors line() const noexcept {  // the direction from p's centre to q's, of length 1
    const Floats far = distance + E::all(kMinDistance);
    return {d.x / far, d.y / far, d.z / far};
  }
  // Calls take(gap, axis, along) for the axes of both boxes. `axis` is of length 1 to within 1e-6; it points from p to
  // q if `along` is at least 0, otherwise from q to p. Returns the gap along the line of the centres.
  template <typename Take>
  ORCHARD_INLINE Floats each_axis(Take&& take) const noexcept {
    const Floats signed_n = E::dot(d, q.n), signed_m = E::dot(d, q.m), signed_l = E::dot(d, q.l);
    const Floats over_n = E::abs(signed_n), over_m = E::abs(signed_m), over_l = E::abs(signed_l), zero = E::all(0.0f);
    Floats reach = q.height * over_n + q.width * over_m + q.length * over_l;
    Vectors across = {zero, zero, zero};  // how far p reaches along q's axes
    const auto along = [&](const Vectors& u, const Floats& own) ORCHARD_INLINE_LAMBDA {
      const Floats by = E::dot(d, u), over = E::abs(by);
      const Floats un = E::abs(E::dot(u, q.n)), um = E::abs(E::dot(u, q.m)), ul = E::abs(E::dot(u, q.l));
      const Floats other = E::min(q.height * un + q.width * um + q.length * ul, q.radius);
      take(over - (own + other), u, by);
      reach = reach + own * over;
      across = {across.x + own * un, across.y + own * um, across.z + own * ul};
    };
    along(p.n, p.height), along(p.m, p.width), along(p.l, p.length);
    take(over_n - (q.height + E::min(across.x, p.radius)), q.n, signed_n);
    take(over_m - (q.width + E::min(across.y, p.radius)), q.m, signed_m);
    take(over_l - (q.length + E::min(across.z, p.radius)), q.l, signed_l);
    return distance - reach / (distance + E::all(kMinDistance));
  }
};

}  // namespace orchard::runtime::detail
