#include "collision/kernels/box_time.h"

#include <limits>

#include "collision/kernels/box_pair.h"
#include "collision/kernels/eight.h"
#include "simd/machine.h"

// Rates are rounded up. Their own rounding error is below 40 u of the sum of the sizes of their parts, with u = 2^-24,
// and kRateError is more.
namespace orchard::runtime::detail {
namespace {

constexpr float kRateError = 0x1p-17f;
constexpr float kMinRate = 1e-30f;  // gaps are below 1e20, so with this rate, times are beyond every end, or infinite
constexpr float kTimeError = 1 - 0x1p-20f;

template <typename Kind>
struct Turns {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  Vectors axis;
  Floats spin, steady;  // times the reach of the box from the centre of rotation

  ORCHARD_INLINE Turns(const Turning& turning, const Boxes<Kind>& boxes, float rounding) noexcept
      : axis(E::all_of(turning.axis)) {
    const Vectors from = E::minus(boxes.center, E::all_of(turning.center));
    const Floats reach = (Kind::sqrt(E::dot(from, from)) + boxes.radius) * E::all(1 + 0x1p-18f) + E::all(rounding);
    spin = reach * E::all(turning.spin), steady = reach * E::all(turning.turning);
  }
  // Returns a bound on the speed at which a point of the box comes closer along u.
  ORCHARD_INLINE Floats rate(const Vectors& u) const noexcept {
    const Vectors across = E::cross(axis, u);
    return spin * (Kind::sqrt(E::dot(across, across)) + E::all(kRateError)) + steady;
  }
};

template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE void find_times(const NodeBox& single, const ObbNodeBlock& lanes, float scale, const Closing& closing,
                               float margin, BoxTimes& result) noexcept {
  const Boxes<Kind> p = Boxes<Kind>::of(single), q = Boxes<Kind>::of(lanes, scale);
  const Vectors v = E::all_of(closing.velocity);
  const Turns<Kind> single_turns(closing.single, p, closing.rounding), lane_turns(closing.lanes, q, closing.rounding);
  const Floats steady = E::all(closing.speed) + E::one_norm(v) * E::all(kRateError);
  Floats best = E::all(-std::numeric_limits<float>::infinity());
  const auto take = [&](const Floats& gap, const Vectors& u, const Floats& along) ORCHARD_INLINE_LAMBDA {
    const Floats speed = E::dot(v, u), opening = Kind::choose(along < E::all(0.0f), -speed, speed);
    const Floats rate = (steady - opening) + (lane_turns.rate(u) + single_turns.rate(u));
    const Floats least = E::max(rate + E::abs(rate) * E::all(kRateError), E::all(kMinRate));
    best = E::max(best, (gap - E::all(margin)) / least);
  };
  const BoxPair<Kind> pair(p, q);
  const Floats by_line = pair.each_axis(take);
  take(E::max(by_line, pair.ball_gap), pair.line(), E::all(0.0f));
  store(best * E::all(kTimeError), result.time);
  result.used = Kind::bits(E::all(0.0f) <= E::at(lanes.radius));
}

}  // namespace

void box_times(const NodeBox& single, const ObbNodeBlock& lanes, float scale, const Closing& closing, float margin,
               BoxTimes& result) noexcept {
  PerMachine<find_times<Widest>, find_times<Base>, find_times<PlainFloats>>::call(single, lanes, scale, closing, margin,
                                                                                  result);
}

}  // namespace orchard::runtime::detail
