#include "broad_phase/horn.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

double largest(const Vec3& v) noexcept { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }

// Lemma 4.2 for one body of the pair: its sphere stays behind a plane, so that the other one has to cross it.
double half_space_contact(const Motion& a, const Motion& b, double slack) noexcept {
  const double length = std::sqrt(dot(a.half_space, a.half_space));
  if (!(length > 0)) return 0;
  const Vec3 d = (1 / length) * a.half_space;

  const double gap = dot(b.position - a.position, d) - a.radius - b.radius - slack;
  if (!(gap > 0)) return 0;
  // How much of b's acceleration can point along -d, given its own half-space.
  double share = 1;
  const double other = std::sqrt(dot(b.half_space, b.half_space));
  if (other > 0) {
    const double cosine = dot(d, b.half_space) / other;
    if (cosine < 0) share = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    share = std::min(1.0, share + 1e-7);  // the root of a rounding error
  }
  const double slope = dot(b.velocity - a.velocity, d) - a.drift - b.drift;
  return detail::first_closing(gap, slope, share * b.acceleration);
}

}  // namespace

bool is_valid(const Motion& m) noexcept {
  // Without branches, and mostly enough: NaN stays in a sum and fails the comparison.
  const double squares = dot(m.position, m.position) + dot(m.velocity, m.velocity) + dot(m.half_space, m.half_space) +
                         (m.radius * m.radius + m.acceleration * m.acceleration + m.drift * m.drift);
  const bool in_range = squares <= kMaxNumber * kMaxNumber, signs = m.radius >= 0 && m.acceleration >= 0;
  if (in_range && signs && m.drift >= 0 && !std::isnan(m.expiry)) return true;
  const auto fits = [](double x) { return std::fabs(x) <= kMaxNumber; };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!fits(m.position[i]) || !fits(m.velocity[i]) || !fits(m.half_space[i])) return false;
  }
  const auto bound = [&](double x) { return fits(x) && x >= 0; };
  return bound(m.radius) && bound(m.acceleration) && bound(m.drift) && !std::isnan(m.expiry);
}

Motion speed_bounded(const Vec3& position, double radius, double max_speed, double expiry) noexcept {
  Motion motion;
  motion.position = position;
  motion.radius = radius;
  motion.drift = max_speed;
  motion.expiry = expiry;
  return motion;
}

Motion position_bounded(const Vec3& center, double reach, double radius, double expiry) noexcept {
  constexpr double outward = 1 + 0x1p-50;  // for the rounding of the sum
  Motion motion;
  motion.position = center;
  motion.radius = (reach + radius) * outward;
  motion.expiry = expiry;
  return motion;
}

namespace detail {

double motion_slack(const Motion& a, const Motion& b, double duration) noexcept {
  const auto reach = [&](const Motion& m) {
    return largest(m.position) + m.radius + duration * (largest(m.velocity) + m.drift + duration * m.acceleration / 2);
  };
  return kMotionSlack * (reach(a) + reach(b)) + kMinLength;
}

double first_closing(double gap, double slope, double acceleration) noexcept {
  if (!(gap > 0)) return 0;
  const double root = std::sqrt(slope * slope + 2 * acceleration * gap);
  if (slope < 0) return 2 * gap / (root - slope);  // no cancellation in either form
  return acceleration > 0 ? (slope + root) / acceleration : kNever;
}

// As the root is concave, |offset + v t| <= |offset| + (t offset . v + t^2 v^2 / 2) / |offset|; it is at most
// |offset| + t |v|, too.
double overlap_lasts(const Motion& a, const Motion& b, double limit, double slack) noexcept {
  const Vec3 offset = b.position - a.position, velocity = b.velocity - a.velocity;
  const double distance = std::sqrt(dot(offset, offset)), speed = std::sqrt(dot(velocity, velocity));
  const double spare = a.radius + b.radius - distance - motion_slack(a, b, limit) - slack;
  const double growth = a.drift + b.drift, acceleration = a.acceleration + b.acceleration;
  double sure = first_closing(spare, -(speed + growth), acceleration);
  if (sure < limit && distance > kMinLength) {
    const double parting = dot(offset, velocity) / distance;
    sure = std::max(sure, first_closing(spare, -(parting + growth), acceleration + speed * speed / distance));
  }
  return std::min(limit, sure);
}

double tightened(const Motion& a, const Motion& b, double contact, double limit, double slack) noexcept {
  const double tight = std::max({contact, half_space_contact(a, b, slack), half_space_contact(b, a, slack)});
  return tight <= limit ? tight : kNever;
}

double horn_contact(const HornPair& pair, double limit, double resolution) noexcept {
  double t = 0;
  for (int round = 0; round < kMaxHornRounds; ++round) {
    const Vec3 apart = pair.offset + t * pair.velocity;
    const double distance = std::sqrt(dot(apart, apart));
    const double gap = distance - (pair.radius + t * (pair.growth + t * pair.acceleration / 2));
    if (!(gap > 0)) return t;
    const double slope = dot(apart, pair.velocity) / distance - (pair.growth + t * pair.acceleration);
    const double step = first_closing(gap, slope, pair.acceleration);
    t += step;
    if (!(t <= limit)) return kNever;
    if (step <= resolution) break;
  }
  return t;
}

}  // namespace detail

double earliest_contact(const Motion& a, const Motion& b, double limit, double resolution, double more) noexcept {
  const double slack = detail::motion_slack(a, b, limit) + more;
  const detail::HornPair pair{b.position - a.position, b.velocity - a.velocity, a.radius + b.radius + slack,
                              a.drift + b.drift, a.acceleration + b.acceleration};
  const double contact = detail::horn_contact(pair, limit, resolution);
  return contact <= limit ? detail::tightened(a, b, contact, limit, slack) : kNever;
}

}  // namespace orchard::runtime
