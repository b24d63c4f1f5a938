#include "bound.h"

#include <algorithm>
#include <cmath>

#include "broad_phase/horn.h"

namespace orchard::broad_phase_methods {

SpaceTimeBound make_bound(const Motion& motion, double age, double duration, double more) noexcept {
  SpaceTimeBound bound;
  const double slack = runtime::detail::motion_slack(motion, motion, age + duration) + more;
  bound.center = motion.position + age * motion.velocity;
  bound.velocity = motion.velocity;
  bound.bend = motion.acceleration / 2;
  bound.growth = motion.drift + age * motion.acceleration;
  bound.size = motion.radius + age * (motion.drift + age * bound.bend) + slack;
  bound.slope = bound.growth + duration * bound.bend;  // the chord of a convex function lies above it
  const double length = std::sqrt(dot(motion.half_space, motion.half_space));
  if (length > 0) {
    bound.normal = (1 / length) * motion.half_space;
    bound.cut = motion.radius + age * motion.drift + slack;
    bound.cut_growth = motion.drift;
  }
  return bound;
}

double first_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration, BoundShape shape) noexcept {
  double contact = 0;
  if (shape == BoundShape::horn) {
    constexpr double kConverged = 1e-14;  // of the interval
    const runtime::detail::HornPair pair{b.center - a.center, b.velocity - a.velocity, a.size + b.size,
                                         a.growth + b.growth, 2 * (a.bend + b.bend)};
    contact = runtime::detail::horn_contact(pair, duration, kConverged * duration);
  } else if (shape == BoundShape::quadratic) {
    contact = detail::quadratic_contact(a, b, duration);
  }
  const bool planes = a.has_plane() || b.has_plane();
  if (contact > duration || (!planes && shape != BoundShape::hypertrapezoid)) return contact;

  double trapezoids = detail::trapezoid_contact(a, b, duration);
  if (planes && trapezoids <= duration && !cut_cubes_meet(a, b, trapezoids)) {
    trapezoids = detail::plane_contact(a, b, trapezoids, duration);
  }
  return std::max(contact, trapezoids);
}

namespace detail {

double contact_slack(const SpaceTimeBound& a, const SpaceTimeBound& b, double t) noexcept {
  double largest = a.trapezoid_half(t) + b.trapezoid_half(t);
  for (const SpaceTimeBound* bound : {&a, &b}) {
    for (std::size_t i = 0; i < 3; ++i) {
      largest = std::max(largest, std::fabs(bound->center[i]) + t * std::fabs(bound->velocity[i]));
    }
  }
  return kMotionSlack * largest;
}

bool cubes_meet_at_start(const SpaceTimeBound& a, const SpaceTimeBound& b) noexcept {
  bool meet = true;
  for (std::size_t i = 0; i < 3; ++i) meet = meet && std::fabs(b.center[i] - a.center[i]) <= a.size + b.size;
  return meet;
}

double trapezoid_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration) noexcept {
  double first = 0, last = duration;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {  // they meet along the axis while gap + change t <= 0
      const double gap = side * (b.center[axis] - a.center[axis]) - a.size - b.size;
      const double change = side * (b.velocity[axis] - a.velocity[axis]) - a.slope - b.slope;
      if (change < 0) {
        first = std::max(first, gap / -change);
      } else if (change > 0) {
        last = std::min(last, -gap / change);
      } else if (gap > 0) {
        return kNoContact;
      }
    }
  }
  return first <= last ? first : kNoContact;
}

double quadratic_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration) noexcept {
  struct Interval {
    double begin, end;  // open
  };
  std::array<Interval, 6> apart{};  // along an axis, one before the other
  std::size_t count = 0;
  const double bend = a.bend + b.bend;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {  // while c + h t + bend t^2 < 0
      const double c = a.size + b.size - side * (b.center[axis] - a.center[axis]);
      const double h = a.growth + b.growth - side * (b.velocity[axis] - a.velocity[axis]);
      const double root = std::sqrt(std::max(0.0, h * h - 4 * bend * c));
      if (c < 0) {
        const double end = h > 0 ? -2 * c / (h + root) : bend > 0 ? (root - h) / (2 * bend) : kNoContact;
        apart[count++] = {-1, end};
      } else if (h < 0 && root > 0) {
        apart[count++] = {2 * c / (root - h), bend > 0 ? (root - h) / (2 * bend) : kNoContact};
      }
    }
  }
  double t = 0;
  for (std::size_t i = 0; i < count && t <= duration;) {
    const bool inside = apart[i].begin < t && t < apart[i].end;
    t = inside ? apart[i].end : t;
    i = inside ? 0 : i + 1;
  }
  return t <= duration ? t : kNoContact;
}

}  // namespace detail
}  // namespace orchard::broad_phase_methods
