#include "patch_time.h"

#include "eight.h"
#include "machine.h"
#include "patch_block.h"

// Gaps are those of patch_gaps(), along the same directions. Rates are rounded up: their own rounding is below 40 u of
// the sum of their parts' sizes, u = 2^-24, and kRateError is more.
namespace orchard::runtime::detail {
namespace {

constexpr float kSineError = 0x1p-17f;
constexpr float kLeastDistance = 1e-18f;
constexpr float kRateError = 0x1p-17f;
constexpr float kLeastRate = 1e-30f;  // gaps are below 1e20: a time far beyond every end, or infinite
constexpr float kTimeError = 1 - 0x1p-20f;

template <typename Kind>
struct Turns {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  typename E::Vectors axis;
  Floats spin, steady;  // times the reach of the patch from the centre of rotation

  ORCHARD_INLINE Turns(const Turning& turning, const Floats& reach) noexcept
      : axis{E::all(turning.axis[0]), E::all(turning.axis[1]), E::all(turning.axis[2])},
        spin(reach * E::all(turning.spin)),
        steady(reach * E::all(turning.turning)) {}
  // How fast a point comes closer along u at most.
  ORCHARD_INLINE Floats rate(const typename E::Vectors& u) const noexcept {
    const typename E::Vectors across = E::cross(axis, u);
    return spin * (Kind::root(E::dot(across, across)) + E::all(kRateError)) + steady;
  }
};

template <typename Kind>
ORCHARD_INLINE typename Kind::Floats reach_of(const typename Eight<Kind>::Vectors& c, const typename Kind::Floats& r,
                                              const std::array<float, 3>& center) noexcept {
  using E = Eight<Kind>;
  const typename E::Vectors from = E::minus(c, {E::all(center[0]), E::all(center[1]), E::all(center[2])});
  return (Kind::root(E::dot(from, from)) + r) * E::all(1 + 0x1p-18f);
}

template <typename Kind>
ORCHARD_INLINE void find_times(const Patch& single, const PatchBlock& lanes, const Placement* placement,
                               const Closing& closing, float margin, PatchTimes& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  Vectors c = {load<Floats>(lanes.x), load<Floats>(lanes.y), load<Floats>(lanes.z)};
  Vectors n = {load<Floats>(lanes.nx), load<Floats>(lanes.ny), load<Floats>(lanes.nz)};
  Floats r = load<Floats>(lanes.radius), h = load<Floats>(lanes.height);
  const Floats zero = E::all(0.0f);
  result.used = Kind::bits(zero <= r);
  const bool second = placement != nullptr;
  if (second) {
    c = E::move(*placement, c);
    n = E::turn(placement->turn, n);
    r = r * E::all(placement->scale);
    h = h * E::all(placement->scale);
  }
  store(c.x, result.x), store(c.y, result.y), store(c.z, result.z);
  store(n.x, result.nx), store(n.y, result.ny), store(n.z, result.nz);
  store(r, result.radius), store(h, result.height);

  const Vectors m = {E::all(single.nx), E::all(single.ny), E::all(single.nz)};
  const Vectors place = {E::all(single.x), E::all(single.y), E::all(single.z)};
  const Floats s = E::all(single.radius), k = E::all(single.height), slack = E::all(kSineError), one = E::all(1.0f);
  const Vectors d = E::minus(c, place);
  const Floats square = E::dot(d, d), over_n = E::dot(d, n), over_m = E::dot(d, m);
  const Floats along_n = E::size(over_n), along_m = E::size(over_m), cosine = E::size(E::dot(n, m));
  const Floats sine = Kind::root(E::larger(one - cosine * cosine, zero) + slack);
  const Floats distance = Kind::root(square), slope = square * slack;
  const Floats across_n = Kind::root(E::larger(square - along_n * along_n, zero) + slope);
  const Floats across_m = Kind::root(E::larger(square - along_m * along_m, zero) + slope);
  const Floats by_n = along_n - (h + (k * cosine + s * sine));
  const Floats by_m = along_m - (k + (h * cosine + r * sine));
  const Floats reach = (h * along_n + r * across_n) + (k * along_m + s * across_m);
  const Floats by_line = E::larger(distance - reach / (distance + E::all(kLeastDistance)), distance - (r + s));

  // The lanes' velocity against the single one's, and what turning adds.
  const float sign = second ? 1.0f : -1.0f;
  const Vectors v = {E::all(sign * closing.velocity[0]), E::all(sign * closing.velocity[1]),
                     E::all(sign * closing.velocity[2])};
  const Turning &of_lanes = second ? closing.second : closing.first,
                &of_single = second ? closing.first : closing.second;
  const Turns<Kind> lane_turns(of_lanes, reach_of<Kind>(c, r, of_lanes.center)),
      single_turns(of_single, reach_of<Kind>(place, s, of_single.center));
  const Floats steady = E::all(closing.speed) + E::one_norm(v) * E::all(kRateError);
  const auto time = [&](const Floats& gap, const Floats& opening, const Vectors& u) ORCHARD_INLINE_LAMBDA -> Floats {
    const Floats rate = (steady - opening) + (lane_turns.rate(u) + single_turns.rate(u));
    return (gap - E::all(margin)) / E::larger(rate + E::size(rate) * E::all(kRateError), E::all(kLeastRate));
  };
  const Floats speed_n = E::dot(v, n), speed_m = E::dot(v, m);
  const Floats far = distance + E::all(kLeastDistance);
  const Vectors line = {d.x / far, d.y / far, d.z / far};
  const Floats best = E::larger(E::larger(time(by_n, Kind::choose(over_n < zero, -speed_n, speed_n), n),
                                          time(by_m, Kind::choose(over_m < zero, -speed_m, speed_m), m)),
                                time(by_line, E::dot(v, line), line));
  store(best * E::all(kTimeError), result.time);
}

}  // namespace

void patch_times_scalar(const Patch& single, const PatchBlock& lanes, const Placement* placement,
                        const Closing& closing, float margin, PatchTimes& result) noexcept {
  find_times<PlainFloats>(single, lanes, placement, closing, margin, result);
}

#ifdef ORCHARD_VECTORS
using Widest = VectorFloats;
using Base = FourFloats;
#else
using Widest = PlainFloats;
using Base = PlainFloats;
#endif

void patch_times(const Patch& single, const PatchBlock& lanes, const Placement* placement, const Closing& closing,
                 float margin, PatchTimes& result) noexcept {
  PerMachine<find_times<Widest>, find_times<Base>>::call(single, lanes, placement, closing, margin, result);
}

}  // namespace orchard::runtime::detail
