#include "broad_phase/horn.h"

#include <algorithm>
#include <cmath>

#include "broad_phase/motion_lanes.h"

namespace orchard::runtime {
namespace detail {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kMaxRounds = 100;  // a grazing contact halves the gap per round; stopping makes the time early, not late

template <typename Kind>
ORCHARD_INLINE auto reach_of(const MotionLanes<typename Kind::Numbers>& m,
                             const typename Kind::Numbers& duration) noexcept {
  const auto largest = [](const auto& v) ORCHARD_INLINE_LAMBDA {
    const auto abs = [](const auto& x) ORCHARD_INLINE_LAMBDA { return most<Kind>(x, -x); };
    return most<Kind>(most<Kind>(abs(v[0]), abs(v[1])), abs(v[2]));
  };
  return largest(m.position) + m.radius + duration * (largest(m.velocity) + m.drift + duration * m.acceleration / 2);
}

template <typename Kind>
ORCHARD_INLINE auto slack_of(const MotionLanes<typename Kind::Numbers>& a, const MotionLanes<typename Kind::Numbers>& b,
                             const typename Kind::Numbers& duration) noexcept {
  return all_of<Kind>(kMotionSlack) * (reach_of<Kind>(a, duration) + reach_of<Kind>(b, duration)) +
         all_of<Kind>(kMinLength);
}

// Returns the first t >= 0 with gap + slope t - acceleration t^2 / 2 <= 0, or infinity if there is none. The result
// has no meaning where the gap is not positive. Precondition: acceleration >= 0.
template <typename Kind, typename Numbers = typename Kind::Numbers>
ORCHARD_INLINE Numbers closing(const Numbers& gap, const Numbers& slope, const Numbers& acceleration) noexcept {
  const Numbers root = Kind::sqrt(slope * slope + 2 * acceleration * gap);
  const auto down = slope < 0;  // no cancellation occurs in either form
  const Numbers above = Kind::choose(down, 2 * gap, slope + root),
                below = Kind::choose(down, root - slope, acceleration);
  return Kind::choose(below > 0, above / below, all_of<Kind>(kNever));
}

template <typename Kind, typename Numbers = typename Kind::Numbers>
ORCHARD_INLINE Numbers contact_of(const Horns<Numbers>& p, typename Kind::Mask open, const Numbers& limit,
                                  double resolution) noexcept {
  const Numbers never = all_of<Kind>(kNever);
  Numbers t = all_of<Kind>(0), found = never;
  for (int round = 0; round < kMaxRounds; ++round) {
    std::array<Numbers, 3> at;
    for (std::size_t d = 0; d < 3; ++d) at[d] = p.offset[d] + t * p.velocity[d];
    const Numbers distance = Kind::sqrt(dot_of(at, at));
    const Numbers gap = distance - (p.radius + t * (p.growth + t * p.acceleration / 2));
    const Numbers slope = dot_of(at, p.velocity) / distance - (p.growth + t * p.acceleration);
    const Numbers step = closing<Kind>(gap, slope, p.acceleration), next = t + step;
    const auto apart = gap > 0, in_time = next <= limit;
    found = Kind::choose(open, Kind::choose(apart, Kind::choose(in_time, next, never), t), found);
    open = open & apart & in_time & (step > all_of<Kind>(resolution));
    if (!Kind::any(open)) break;
    t = Kind::choose(open, next, t);  // the next time of other lanes may be infinite
  }
  return found;
}

// Returns how long two bodies that touch certainly overlap, at most `limit`. `p.radius` is the sum of the radii less
// all slack. As the root is concave, |offset + v t| <= |offset| + (t offset . v + t^2 v^2 / 2) / |offset|; it is also
// at most |offset| + t |v|.
template <typename Kind, typename Numbers = typename Kind::Numbers>
ORCHARD_INLINE Numbers lasting_of(const Horns<Numbers>& p, const Numbers& limit) noexcept {
  const Numbers distance = Kind::sqrt(dot_of(p.offset, p.offset)), speed = Kind::sqrt(dot_of(p.velocity, p.velocity));
  const Numbers spare = p.radius - distance, parting = dot_of(p.offset, p.velocity) / distance;
  const auto first = [&](const Numbers& slope, const Numbers& acceleration) ORCHARD_INLINE_LAMBDA {
    return Kind::choose(spare > 0, closing<Kind>(spare, slope, acceleration), all_of<Kind>(0));
  };
  const Numbers sure = first(-(speed + p.growth), p.acceleration);
  const Numbers tangent = first(-(parting + p.growth), p.acceleration + speed * speed / distance);
  const auto better = (sure < tangent) & (sure < limit) & (distance > all_of<Kind>(kMinLength));
  return least<Kind>(limit, Kind::choose(better, tangent, sure));
}

// Returns the earliest contact by Lemma 4.2 for body a: its sphere stays behind a plane, so the other body has to cross
// that. Returns 0 if a has no half-space, or if there is no gap along its normal.
template <typename Kind, typename Numbers = typename Kind::Numbers>
ORCHARD_INLINE Numbers half_space_contact(const MotionLanes<Numbers>& a, const MotionLanes<Numbers>& b,
                                          const Numbers& slack) noexcept {
  const Numbers zero = all_of<Kind>(0), one = all_of<Kind>(1);
  const Numbers length = Kind::sqrt(dot_of(a.half_space, a.half_space)),
                other = Kind::sqrt(dot_of(b.half_space, b.half_space)), unit = one / length;
  std::array<Numbers, 3> d, way, speed;
  for (std::size_t i = 0; i < 3; ++i) {
    d[i] = unit * a.half_space[i], way[i] = b.position[i] - a.position[i], speed[i] = b.velocity[i] - a.velocity[i];
  }
  const Numbers gap = dot_of(way, d) - a.radius - b.radius - slack;
  // `share` is the part of b's acceleration that can point along -d, given b's own half-space.
  const Numbers cosine = dot_of(d, b.half_space) / other;
  const Numbers sine = Kind::sqrt(most<Kind>(zero, one - cosine * cosine));
  const Numbers some = least<Kind>(one, Kind::choose(cosine < zero, sine, one) + all_of<Kind>(1e-7));  // a root's error
  const Numbers share = Kind::choose(other > zero, some, one);
  const Numbers slope = dot_of(speed, d) - a.drift - b.drift;
  const Numbers contact = closing<Kind>(gap, slope, share * b.acceleration);
  return Kind::choose(both(length > zero, gap > zero), contact, zero);
}

// Returns the contact as delayed by the half-spaces of the two bodies: it is not before both allow it, and infinity if
// that is after the limit.
template <typename Kind, typename Numbers = typename Kind::Numbers>
ORCHARD_INLINE Numbers tightened(const MotionLanes<Numbers>& a, const MotionLanes<Numbers>& b, const Numbers& contact,
                                 const Numbers& limit, const Numbers& slack) noexcept {
  const Numbers tight =
      most<Kind>(contact, most<Kind>(half_space_contact<Kind>(a, b, slack), half_space_contact<Kind>(b, a, slack)));
  return Kind::choose(tight <= limit, tight, all_of<Kind>(kNever));
}

// Computes the times of as many pairs as the kind has numbers. Returns false if a motion may be invalid.
template <typename Kind, typename Numbers = typename Kind::Numbers>
ORCHARD_INLINE bool find_times(const Motion* motions, const double* limits, const PairPrecision& precision,
                               double* seconds, bool* touching) noexcept {
  const auto every_other = [&](std::size_t first) ORCHARD_INLINE_LAMBDA {
    return Kind::motions([=](std::size_t i) ORCHARD_INLINE_LAMBDA { return motions + 2 * i + first; });
  };
  const MotionLanes<Numbers> a = every_other(0), b = every_other(1);
  if (!precision.valid && !Kind::all(both(are_valid<Kind>(a), are_valid<Kind>(b)))) return false;
  const Numbers limit = load_lanes<Kind>(limits);
  Horns<Numbers> p;
  auto half_spaces = all_of<Kind>(0);
  for (std::size_t d = 0; d < 3; ++d) {
    p.offset[d] = b.position[d] - a.position[d];
    p.velocity[d] = b.velocity[d] - a.velocity[d];
    half_spaces = half_spaces + (a.half_space[d] * a.half_space[d] + b.half_space[d] * b.half_space[d]);
  }
  const Numbers radii = a.radius + b.radius, slacks = slack_of<Kind>(a, b, limit) + all_of<Kind>(precision.slack);
  p.growth = a.drift + b.drift;
  p.acceleration = a.acceleration + b.acceleration;
  const Numbers squared = dot_of(p.offset, p.offset);
  const auto touch = squared <= radii * radii;
  Numbers time = all_of<Kind>(0);
  if (Kind::any(touch)) {
    p.radius = radii - slacks;
    time = lasting_of<Kind>(p, limit);
  }
  if (!Kind::all(touch)) {
    p.radius = radii + slacks;
    time = Kind::choose(touch, time, contact_of<Kind>(p, squared > radii * radii, limit, precision.resolution));
  }
  const auto tighter = both(both(half_spaces > 0, time <= limit), squared > radii * radii);  // few bodies have one
  if (Kind::any(tighter)) time = Kind::choose(touch, time, tightened<Kind>(a, b, time, limit, slacks));
  std::memcpy(seconds, &time, sizeof time);
  const std::uint32_t touches = Kind::bits(touch);
  for (std::size_t i = 0; i < Kind::kLanes; ++i) touching[i] = (touches >> i & 1) != 0;
  return true;
}

template <typename Kind>
ORCHARD_INLINE bool find_all_times(std::span<const Motion> motions, std::span<const double> limits,
                                   const PairPrecision& precision, PairTimes& times) noexcept {
  constexpr std::size_t kLanes = Kind::kLanes;
  std::size_t i = 0;
  for (; i + kLanes <= limits.size(); i += kLanes) {
    if (!find_times<Kind>(&motions[2 * i], &limits[i], precision, &times.seconds[i], &times.touching[i])) return false;
  }
  if (i == limits.size()) return true;
  std::array<Motion, 2 * kLanes> rest{};
  std::array<double, kLanes> rest_limits{};
  std::copy(motions.begin() + static_cast<std::ptrdiff_t>(2 * i), motions.end(), rest.begin());
  std::copy(limits.begin() + static_cast<std::ptrdiff_t>(i), limits.end(), rest_limits.begin());
  return find_times<Kind>(rest.data(), rest_limits.data(), precision, &times.seconds[i], &times.touching[i]);
}

MotionLanes<double> one_of(const Motion& m) noexcept {
  return OneDouble::motions([&m](std::size_t) { return &m; });
}

}  // namespace

double motion_slack(const Motion& a, const Motion& b, double duration) noexcept {
  return slack_of<OneDouble>(one_of(a), one_of(b), duration);
}

double horn_contact(const HornPair& pair, double limit, double resolution) noexcept {
  return contact_of<OneDouble>(pair, true, limit, resolution);
}

bool find_pair_times(std::span<const Motion> motions, std::span<const double> limits, const PairPrecision& precision,
                     PairTimes& times) noexcept {
  const auto timeless = [](const Motion& motion) { return std::isnan(motion.expiry); };
  if (!precision.valid && std::any_of(motions.begin(), motions.end(), timeless)) return false;
  bool valid = false;
  with_best_lanes([&]<typename Kind>()
                      ORCHARD_INLINE_LAMBDA { valid = find_all_times<Kind>(motions, limits, precision, times); });
  return valid;
}

}  // namespace detail

double earliest_contact(const Motion& a, const Motion& b, double limit, double resolution, double more) noexcept {
  const double slack = detail::motion_slack(a, b, limit) + more;
  const detail::HornPair pair{b.position - a.position, b.velocity - a.velocity, a.radius + b.radius + slack,
                              a.drift + b.drift, a.acceleration + b.acceleration};
  const double contact = detail::horn_contact(pair, limit, resolution);
  return detail::tightened<detail::OneDouble>(detail::one_of(a), detail::one_of(b), contact, limit, slack);
}

}  // namespace orchard::runtime
