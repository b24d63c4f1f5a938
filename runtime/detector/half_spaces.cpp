#include "detector/half_spaces.h"

#include <algorithm>

#include "orchard/runtime/motion_monitor.h"

namespace orchard::runtime::detail {
namespace {

// Returns a lower bound on the height of the body's sphere over the plane.
double height_over(const HalfSpace& half, const Motion& motion) noexcept {
  const double size = std::fabs(half.offset) + length(motion.position) + motion.radius;
  return dot(half.normal, motion.position) - half.offset - motion.radius - kMotionSlack * size;
}

// Returns the number of seconds for which the sphere certainly stays above the plane: the root of height + v s - drift
// s - M s^2 / 2 = 0.
double seconds_above(const HalfSpace& half, const Motion& motion, double height) noexcept {
  if (height <= 0) return 0;
  const double fall = (motion.drift - dot(half.normal, motion.velocity)) * (1 + 1e-12),
               half_m = motion.acceleration / 2;
  const double root = std::sqrt(std::max(0.0, fall * fall + 4 * half_m * height));
  // The sign of `fall` decides which form of the root is used, so that nothing cancels. The first form would be 0 / 0
  // if the body neither falls nor accelerates.
  const double below = fall + root;
  if (fall >= 0) return below > 0 ? 2 * height / below : kInfinity;
  return half_m > 0 ? (root - fall) / (2 * half_m) : kInfinity;
}

}  // namespace

BodyIndex HalfSpaces::add(const HalfSpace& half, const Body& with) {
  // An index is never reused, because pairs may still refer to a half-space that was removed. Half-spaces are few.
  Shape shape;
  shape.kind = ShapeKind::half_space, shape.half = half;
  planes_.push_back({std::move(shape), with});
  const auto index = static_cast<BodyIndex>(kFirstHalfSpace + planes_.size() - 1);
  planes_.back().body.id = {index, 1};
  planes_.back().body.is_static = true;
  return index;
}

bool HalfSpaces::remove(BodyIndex index) noexcept {
  Plane& plane = planes_[index - kFirstHalfSpace];
  if (plane.body.id == kNoBody) return false;
  plane.body.id = kNoBody;
  return true;
}

void HalfSpaceTimes::set_due(BodyIndex body, Step due) {
  while (due_.size() <= body) append(due_, kNeverStep);
  grow(bounds_, due_.size());
  make_room(moving_, due_.size());
  moving_known_ = moving_known_ && (due_[body] == kNeverStep) == (due == kNeverStep);
  due_[body] = due;
  if (due == 0) next_ = 0;
}

void HalfSpaceTimes::update_all() noexcept {
  for (Step& due : due_) due = due == kNeverStep ? kNeverStep : 0;
  next_ = 0;
}

void HalfSpaceTimes::due(Step now, std::vector<BodyIndex>& bodies) {
  if (next() > now) return;
  if (!std::exchange(moving_known_, true)) {
    moving_.clear();
    for (BodyIndex body = 0; body < due_.size(); ++body) {
      if (due_[body] != kNeverStep) moving_.push_back(body);
    }
  }
  Step next = kNeverStep;
  for (const BodyIndex body : moving_) {
    if (due_[body] <= now)
      bodies.push_back(body);
    else
      next = std::min(next, due_[body]);
  }
  next_ = next;
}

void HalfSpaceTimes::update(const Body& body, Step now, const Clock& clock, Motion motion, double slack,
                            std::vector<BodyPair>& pairs) {
  const BodyIndex index = body.id.index;
  slack_ = slack;
  motion.radius += 2 * slack;  // one for the present position, one for the position that the bounds predict
  bounds_[index] = {clock.time(now), motion, body.relies_on_middle(clock.time_step)};
  Step due = now + 1;
  if (is_valid(motion)) {
    double seconds = kInfinity;
    const std::size_t before = pairs.size();
    halves_.each([&](const Body& of, const Shape& shape) {
      const double height = height_over(shape.half, motion);
      seconds = std::min(seconds, seconds_above(shape.half, motion, height));
      if (!(height > 0)) pairs.push_back({index, of.id.index});
    });
    const Step last = body.frozen ? kNeverStep : clock.last_before_expiry(motion.expiry);
    const Step known = last >= kNeverStep - 1 ? kNeverStep - 1 : std::max(now, last) + 1;
    const Step free = clock.steps_before(std::min(seconds, 1e12 * clock.time_step), now);
    if (pairs.size() == before) due = std::min(known, now + std::max<Step>(1, free));
  }
  due_[index] = due;
  next_ = std::min(next_, due);
}

bool HalfSpaceTimes::motion_bound_kept(BodyIndex body, double time, const Motion& now) const noexcept {
  if (halves_.empty() || body >= due_.size() || due_[body] <= 0 || due_[body] == kNeverStep) return true;
  const MotionBound& bound = bounds_[body];
  return keeps_motion_bound(bound.motion, bound.time, time, now.position, nullptr, slack_) &&
         now.radius <= bound.motion.radius;
}

}  // namespace orchard::runtime::detail
