#include "collision/kernels/obb_node_time.h"

#include "collision/kernels/eight.h"
#include "collision/kernels/obb_node_pair.h"
#include "simd/machine.h"

// Gaps are those of ObbNodePair, along the same directions. Rates are rounded up: their own rounding is below 40 u
// of the sum of their parts' sizes, u = 2^-24, and kRateError is more.
namespace orchard::runtime::detail {
namespace {

constexpr float kRateError = 0x1p-17f;
constexpr float kMinRate = 1e-30f;  // gaps are below 1e20: a time far beyond every end, or infinite
constexpr float kTimeError = 1 - 0x1p-20f;

template <typename Kind>
struct Turns {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  typename E::Vectors axis;
  Floats spin, steady;  // times the reach of the ball slab from the centre of rotation

  ORCHARD_INLINE Turns(const Turning& turning, const Floats& reach) noexcept
      : axis{E::all(turning.axis[0]), E::all(turning.axis[1]), E::all(turning.axis[2])},
        spin(reach * E::all(turning.spin)),
        steady(reach * E::all(turning.turning)) {}
  // How fast a point comes closer along u at most.
  ORCHARD_INLINE Floats rate(const typename E::Vectors& u) const noexcept {
    const typename E::Vectors across = E::cross(axis, u);
    return spin * (Kind::sqrt(E::dot(across, across)) + E::all(kRateError)) + steady;
  }
};

template <typename Kind>
ORCHARD_INLINE typename Kind::Floats reach_of(const typename Eight<Kind>::Vectors& c, const typename Kind::Floats& r,
                                              const std::array<float, 3>& center) noexcept {
  using E = Eight<Kind>;
  const typename E::Vectors from = E::minus(c, {E::all(center[0]), E::all(center[1]), E::all(center[2])});
  return (Kind::sqrt(E::dot(from, from)) + r) * E::all(1 + 0x1p-18f);
}

template <typename Kind>
ORCHARD_INLINE void find_times(const ObbNode& single, const ObbNodeBlock& lanes, const Placement* placement,
                               const Closing& closing, float margin, ObbNodeTimes& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const ObbNodePair<Kind> pair(single, lanes, placement, result);
  const bool second = placement != nullptr;

  // The lanes' velocity against the single one's, and what turning adds.
  const float sign = second ? 1.0f : -1.0f;
  const Vectors v = {E::all(sign * closing.velocity[0]), E::all(sign * closing.velocity[1]),
                     E::all(sign * closing.velocity[2])};
  const Turning &of_lanes = second ? closing.second : closing.first,
                &of_single = second ? closing.first : closing.second;
  const Turns<Kind> lane_turns(of_lanes, reach_of<Kind>(pair.c, pair.r, of_lanes.center)),
      single_turns(of_single, reach_of<Kind>(pair.place, pair.s, of_single.center));
  const Floats steady = E::all(closing.speed) + E::one_norm(v) * E::all(kRateError);
  const auto time = [&](const Floats& gap, const Floats& opening, const Vectors& u) ORCHARD_INLINE_LAMBDA -> Floats {
    const Floats rate = (steady - opening) + (lane_turns.rate(u) + single_turns.rate(u));
    return (gap - E::all(margin)) / E::max(rate + E::abs(rate) * E::all(kRateError), E::all(kMinRate));
  };
  const Floats speed_n = E::dot(v, pair.n), speed_m = E::dot(v, pair.m), zero = E::all(0.0f);
  const Floats far = pair.distance + E::all(kMinDistance);
  const Vectors line = {pair.d.x / far, pair.d.y / far, pair.d.z / far};
  const Floats best = E::max(E::max(time(pair.by_n, Kind::choose(pair.over_n < zero, -speed_n, speed_n), pair.n),
                                    time(pair.by_m, Kind::choose(pair.over_m < zero, -speed_m, speed_m), pair.m)),
                             time(pair.by_line, E::dot(v, line), line));
  store(best * E::all(kTimeError), result.time);
}

}  // namespace

void obb_node_times_scalar(const ObbNode& single, const ObbNodeBlock& lanes, const Placement* placement,
                           const Closing& closing, float margin, ObbNodeTimes& result) noexcept {
  find_times<PlainFloats>(single, lanes, placement, closing, margin, result);
}

void obb_node_times(const ObbNode& single, const ObbNodeBlock& lanes, const Placement* placement,
                    const Closing& closing, float margin, ObbNodeTimes& result) noexcept {
  PerMachine<find_times<Widest>, find_times<Base>>::call(single, lanes, placement, closing, margin, result);
}

}  // namespace orchard::runtime::detail
