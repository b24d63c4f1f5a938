#include "node_box.h"

#include <cmath>

#include "ball_slab_pair.h"
#include "eight.h"
#include "machine.h"

// Rounding: narrow_phase.cpp, (6).
namespace orchard::runtime::detail {
namespace {

struct Axes {
  std::array<float, 3> n, m, l;
};

ORCHARD_INLINE Axes axes_of(const NodeBox& b) noexcept {
  return {{b.n[0], b.n[1], b.n[2]}, {b.m[0], b.m[1], b.m[2]}, third_normal(b)};
}

template <typename Kind>
struct BoxPair {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;

  const NodeBox& single;
  const BallSlabBlock& lanes;
  std::uint32_t lane;
  Floats unit, radius;
  Vectors d;        // from the single one's centre to the lanes'
  Floats distance;  // of the centres
  Floats ball_gap;

  ORCHARD_INLINE BoxPair(const NodeBox& single_box, const BallSlabBlock& block, float scale,
                         std::uint32_t which) noexcept
      : single(single_box),
        lanes(block),
        lane(which),
        unit(E::all(scale)),
        radius(E::at(lanes.radius, lane) * unit),
        d{E::at(lanes.x, lane) * unit - E::all(single.center[0]),
          E::at(lanes.y, lane) * unit - E::all(single.center[1]),
          E::at(lanes.z, lane) * unit - E::all(single.center[2])},
        distance(Kind::root(E::dot(d, d))),
        ball_gap(distance - (radius + E::all(single.radius))) {}

  // Along the axes of both boxes and the line of the centres, and between the balls.
  ORCHARD_INLINE Floats gap(const Axes& axes) const noexcept {
    const Vectors n = {E::at(lanes.nx, lane), E::at(lanes.ny, lane), E::at(lanes.nz, lane)};
    const Vectors m = {E::at(lanes.mx, lane), E::at(lanes.my, lane), E::at(lanes.mz, lane)};
    const Vectors l = E::cross(n, m);
    const Floats h = E::at(lanes.height, lane) * unit, w = E::at(lanes.width, lane) * unit,
                 k = E::at(lanes.length, lane) * unit;
    const Floats over_n = E::size(E::dot(d, n)), over_m = E::size(E::dot(d, m)), over_l = E::size(E::dot(d, l));
    Floats reach = h * over_n + w * over_m + k * over_l;
    Floats best = ball_gap;
    // Along an axis of the single one, which adds how far it reaches along the lanes' own.
    const auto take = [&](const std::array<float, 3>& axis, float size, Vectors& across) ORCHARD_INLINE_LAMBDA {
      const Vectors u = {E::all(axis[0]), E::all(axis[1]), E::all(axis[2])};
      const Floats own = E::all(size), over = E::size(E::dot(d, u));
      const Floats un = E::size(E::dot(u, n)), um = E::size(E::dot(u, m)), ul = E::size(E::dot(u, l));
      best = E::larger(best, over - (own + E::smaller(h * un + w * um + k * ul, radius)));
      reach = reach + own * over;
      across = {across.x + own * un, across.y + own * um, across.z + own * ul};
    };
    Vectors across = {E::all(0.0f), E::all(0.0f), E::all(0.0f)};
    take(axes.n, single.height, across), take(axes.m, single.width, across), take(axes.l, single.length, across);
    const Floats most = E::all(single.radius);
    best = E::larger(best, over_n - (h + E::smaller(across.x, most)));
    best = E::larger(best, over_m - (w + E::smaller(across.y, most)));
    best = E::larger(best, over_l - (k + E::smaller(across.z, most)));
    return E::larger(best, distance - reach / (distance + E::all(kMinDistance)));
  }
};

template <typename Kind>
ORCHARD_INLINE void find_gaps(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                              BoxGaps& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  const Floats gap = BoxPair<Kind>(single, lanes, scale, 0).gap(axes_of(single)) - E::all(margin);
  store(gap, result.gap);
  result.used = Kind::bits(E::all(0.0f) <= load<Floats>(lanes.radius));
  result.meeting = result.used & Kind::bits(gap <= E::all(0.0f));
}

void find_gaps_one_by_one(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                          bool only_meeting, BoxGaps& result) noexcept {
  const Axes axes = axes_of(single);
  result.used = result.meeting = 0;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
    const bool in_use = lanes.radius[i] >= 0;
    result.used |= std::uint32_t{in_use} << i;
    if (only_meeting && !in_use) continue;
    const BoxPair<OneFloat> pair(single, lanes, scale, i);
    if (only_meeting && pair.ball_gap - margin > 0) continue;
    result.gap[i] = pair.gap(axes) - margin;
    result.meeting |= std::uint32_t{in_use && result.gap[i] <= 0} << i;
  }
}

}  // namespace

void box_gaps_scalar(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                     BoxGaps& result) noexcept {
  find_gaps_one_by_one(single, lanes, scale, margin, false, result);
}

void meeting_boxes_scalar(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                          BoxGaps& result) noexcept {
  find_gaps_one_by_one(single, lanes, scale, margin, true, result);
}

// Without vectors the compiler's own are slower than one number at a time that stops early.
#ifdef ORCHARD_VECTORS
void box_gaps(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  PerMachine<find_gaps<Widest>, find_gaps<Base>>::call(single, lanes, scale, margin, result);
}
void meeting_boxes(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                   BoxGaps& result) noexcept {
  box_gaps(single, lanes, scale, margin, result);
}
#else
void box_gaps(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  box_gaps_scalar(single, lanes, scale, margin, result);
}
void meeting_boxes(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                   BoxGaps& result) noexcept {
  meeting_boxes_scalar(single, lanes, scale, margin, result);
}
#endif

}  // namespace orchard::runtime::detail
