#include "broad_phase/pair_times.h"

#include "broad_phase/four_motions.h"
#include "broad_phase/horn.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {

void find_pair_times(std::span<const Motion> motions, std::span<const double> limits, double resolution, double slack,
                     PairTimes& times) noexcept {
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const Motion &a = motions[2 * i], &b = motions[2 * i + 1];
    times.touching[i] = spheres_touch(a, b);
    times.seconds[i] = times.touching[i] ? overlap_lasts(a, b, limits[i], slack)
                                         : earliest_contact(a, b, limits[i], resolution, slack);
  }
}

#ifdef ORCHARD_VECTORS
namespace {

using Kind = VectorDoubles;
using Numbers = Kind::Numbers;
using Mask = Kind::Mask;

ORCHARD_INLINE Numbers all_of(double x) noexcept { return spread<Numbers>(x); }

struct FourMotions {
  std::array<Numbers, 3> position, velocity, half_space;
  Numbers radius, acceleration, drift;
};

ORCHARD_INLINE FourMotions every_other(const Motion* m) noexcept {
  const auto which = [m](std::size_t i) ORCHARD_INLINE_LAMBDA { return m + 2 * i; };
  const auto first = Kind::transposed(which, kPositionAndVelocity),
             second = Kind::transposed(which, kVelocityAndRadius), third = Kind::transposed(which, kDriftAndHalfSpace);
  return {{first[0], first[1], first[2]},
          {first[3], second[0], second[1]},
          {third[1], third[2], third[3]},
          second[2],
          second[3],
          third[0]};
}

using Three = std::array<Numbers, 3>;
ORCHARD_INLINE Numbers dot_of(const Three& a, const Three& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ORCHARD_INLINE Numbers largest_of(const Three& a) noexcept {
  return Kind::max(Kind::max(Kind::abs(a[0]), Kind::abs(a[1])), Kind::abs(a[2]));
}

// As is_valid() says without its second look; NaN fails.
ORCHARD_INLINE Mask are_valid(const FourMotions& m) noexcept {
  const Numbers squares = dot_of(m.position, m.position) + dot_of(m.velocity, m.velocity) +
                          dot_of(m.half_space, m.half_space) +
                          (m.radius * m.radius + m.acceleration * m.acceleration + m.drift * m.drift);
  const Numbers least = Kind::min(Kind::min(m.radius, m.acceleration), m.drift);
  return (squares <= all_of(kMaxNumber * kMaxNumber)) & (all_of(0) <= least);
}

ORCHARD_INLINE Numbers reach_of(const FourMotions& m, const Numbers& duration) noexcept {
  return largest_of(m.position) + m.radius +
         duration * (largest_of(m.velocity) + m.drift + duration * m.acceleration / 2);
}

// first_closing(), where the gap is positive; else anything.
ORCHARD_INLINE Numbers closing(const Numbers& gap, const Numbers& slope, const Numbers& acceleration) noexcept {
  const Numbers root = Kind::sqrt(slope * slope + 2 * acceleration * gap);
  const Mask down = slope < 0;
  const Numbers above = Kind::choose(down, 2 * gap, slope + root),
                below = Kind::choose(down, root - slope, acceleration);
  return Kind::choose(below > 0, above / below, all_of(std::numeric_limits<double>::infinity()));
}

// Four pairs as HornPair, by what they have in common.
struct FourPairs {
  Three offset, velocity;
  Numbers radii, growth, acceleration, slack, limit, squared, distance, parting;
};

ORCHARD_INLINE FourPairs pairs_of(const FourMotions& a, const FourMotions& b, const Numbers& limit) noexcept {
  FourPairs p;
  for (std::size_t d = 0; d < 3; ++d) {
    p.offset[d] = b.position[d] - a.position[d];
    p.velocity[d] = b.velocity[d] - a.velocity[d];
  }
  p.radii = a.radius + b.radius;
  p.growth = a.drift + b.drift;
  p.acceleration = a.acceleration + b.acceleration;
  p.slack = all_of(kMotionSlack) * (reach_of(a, limit) + reach_of(b, limit)) + all_of(kMinLength);
  p.limit = limit;
  p.squared = dot_of(p.offset, p.offset);
  p.distance = Kind::sqrt(p.squared);
  p.parting = dot_of(p.offset, p.velocity) / p.distance;
  return p;
}

// overlap_lasts()
ORCHARD_INLINE Numbers lasting(const FourPairs& p, double slack) noexcept {
  const Numbers speed = Kind::sqrt(dot_of(p.velocity, p.velocity));
  const Numbers spare = p.radii - p.distance - p.slack - all_of(slack), zero = all_of(0);
  const auto first = [&](const Numbers& slope, const Numbers& acceleration) ORCHARD_INLINE_LAMBDA {
    return Kind::choose(spare > 0, closing(spare, slope, acceleration), zero);
  };
  const Numbers sure = first(-(speed + p.growth), p.acceleration);
  const Numbers tangent = first(-(p.parting + p.growth), p.acceleration + speed * speed / p.distance);
  const Mask better = (sure < tangent) & (sure < p.limit) & (p.distance > all_of(kMinLength));
  return Kind::min(p.limit, Kind::choose(better, tangent, sure));
}

// horn_contact(), of those that are apart now.
ORCHARD_INLINE Numbers contact(const FourPairs& p, const Mask& apart_now, double resolution, double slack) noexcept {
  Mask open = apart_now;
  const Numbers never = all_of(std::numeric_limits<double>::infinity()), radius = p.radii + (p.slack + all_of(slack));
  Numbers t = all_of(0), found = never, gap = p.distance - radius, slope = p.parting - p.growth;
  for (int round = 0;;) {
    const Numbers step = closing(gap, slope, p.acceleration);
    const Mask apart = gap > 0;
    const Numbers next = t + step;
    const Mask in_time = next <= p.limit;
    found = Kind::choose(open, Kind::choose(apart, Kind::choose(in_time, next, never), t), found);
    open = open & apart & in_time & (step > all_of(resolution));
    if (!Kind::any(open) || ++round == kMaxHornRounds) return found;
    t = Kind::choose(open, next, t);  // that of the others may be infinite
    Three at;
    for (std::size_t d = 0; d < 3; ++d) at[d] = p.offset[d] + t * p.velocity[d];
    const Numbers distance = Kind::sqrt(dot_of(at, at));
    gap = distance - (radius + t * (p.growth + t * p.acceleration / 2));
    slope = dot_of(at, p.velocity) / distance - (p.growth + t * p.acceleration);
  }
}

ORCHARD_INLINE bool have_half_spaces(const FourMotions& a, const FourMotions& b) noexcept {
  const Numbers zero = all_of(0);
  Mask any = zero < zero;
  for (std::size_t d = 0; d < 3; ++d) any = any | (a.half_space[d] != zero) | (b.half_space[d] != zero);
  return Kind::any(any);
}

// Lemma 4.2, which few bodies have: one by one.
void tighten(const Motion* motions, const double* limits, const Numbers& slacks, double* seconds,
             const bool* touching) noexcept {
  for (std::size_t i = 0; i < 4; ++i) {
    if (touching[i] || !(seconds[i] <= limits[i])) continue;
    seconds[i] = tightened(motions[2 * i], motions[2 * i + 1], seconds[i], limits[i], slacks[i]);
  }
}

ORCHARD_INLINE bool find_four(const Motion* motions, const double* limits, double resolution, double slack,
                              double* seconds, bool* touching) noexcept {
  const FourMotions a = every_other(motions), b = every_other(motions + 1);
  if (!Kind::all(are_valid(a) & are_valid(b))) return false;
  const FourPairs p = pairs_of(a, b, Kind::at(limits));
  const Mask touch = p.squared <= p.radii * p.radii;
  for (std::size_t i = 0; i < 4; ++i) touching[i] = touch[i] != 0;
  Numbers time = all_of(0);
  if (Kind::any(touch)) time = lasting(p, slack);
  if (!Kind::all(touch)) time = Kind::choose(touch, time, contact(p, ~touch, resolution, slack));
  std::memcpy(seconds, &time, sizeof time);
  if (have_half_spaces(a, b)) tighten(motions, limits, p.slack + all_of(slack), seconds, touching);
  return true;
}

ORCHARD_INLINE bool find_by_fours(std::span<const Motion> motions, std::span<const double> limits, double resolution,
                                  double slack, PairTimes& times) noexcept {
  std::array<Motion, 8> rest;
  std::array<double, 4> rest_limits;
  for (std::size_t i = 0; i < limits.size(); i += 4) {
    const Motion* some = &motions[2 * i];
    const double* until = &limits[i];
    if (i + 4 > limits.size()) {
      rest = {};
      rest_limits = {};
      std::copy(motions.begin() + static_cast<std::ptrdiff_t>(2 * i), motions.end(), rest.begin());
      std::copy(limits.begin() + static_cast<std::ptrdiff_t>(i), limits.end(), rest_limits.begin());
      some = rest.data();
      until = rest_limits.data();
    }
    if (!find_four(some, until, resolution, slack, &times.seconds[i], &times.touching[i])) return false;
  }
  return true;
}

}  // namespace

bool find_pair_times_at_once(std::span<const Motion> motions, std::span<const double> limits, double resolution,
                             double slack, PairTimes& times) noexcept {
  const Machine chosen = machine();
  if (chosen == Machine::portable) return false;
  const auto timeless = [](const Motion& motion) { return std::isnan(motion.expiry); };
  if (std::any_of(motions.begin(), motions.end(), timeless)) return false;
  bool valid = false;
  const auto work = [&]() ORCHARD_INLINE_LAMBDA { valid = find_by_fours(motions, limits, resolution, slack, times); };
#ifdef ORCHARD_MACHINES
  if (chosen < Machine::avx2) return false;
  chosen == Machine::avx512 ? work_with_avx512(work) : work_with_avx2(work);
#else
  work();
#endif
  return valid;
}
#else
bool find_pair_times_at_once(std::span<const Motion>, std::span<const double>, double, double, PairTimes&) noexcept {
  return false;
}
#endif

}  // namespace orchard::runtime::detail
