#include "detector/half_spaces.h"

#include <algorithm>

#include "orchard/runtime/motion_monitor.h"

namespace orchard::runtime::detail {
namespace {

// How high a body's sphere is over the plane, at least; and after how many seconds it may have come down: the root of
// height + v s - drift s - M s^2 / 2 = 0.
double height_over(const HalfSpace& half, const Motion& motion) noexcept {
  const double size = std::fabs(half.offset) + length(motion.position) + motion.radius;
  return dot(half.normal, motion.position) - half.offset - motion.radius - kMotionSlack * size;
}

double seconds_above(const HalfSpace& half, const Motion& motion, double height) noexcept {
  if (height <= 0) return 0;
  const double fall = (motion.drift - dot(half.normal, motion.velocity)) * (1 + 1e-12),
               half_m = motion.acceleration / 2;
  const double root = std::sqrt(std::max(0.0, fall * fall + 4 * half_m * height));
  // Without cancellation, whichever sign `fall` has; 0 / 0 where it neither falls nor is pulled.
  const double below = fall + root;
  if (fall >= 0) return below > 0 ? 2 * height / below : kInfinity;
  return half_m > 0 ? (root - fall) / (2 * half_m) : kInfinity;
}

}  // namespace

BodyIndex HalfSpaces::add(const HalfSpace& half, const Body& with) {
  // An index is never used again: half-spaces are few, and pairs may still name a removed one.
  planes_.push_back({half, with, true});
  ++alive_;
  const auto index = static_cast<BodyIndex>(kFirstHalfSpace + planes_.size() - 1);
  planes_.back().body.id = {index, 1};
  planes_.back().body.is_static = true;
  return index;
}

bool HalfSpaces::remove(BodyIndex index) noexcept {
  Plane& plane = planes_[index - kFirstHalfSpace];
  if (!plane.alive) return false;
  plane.alive = false;
  plane.body.id = kNoBody;
  --alive_;
  return true;
}

void HalfSpaceTimes::make_room(std::size_t bodies) {
  grow(due_, bodies);
  grow(bounds_, due_.size());
  while (moving_places_.size() < due_.size()) append(moving_places_, kNoIndex);
  detail::make_room(moving_, due_.size());
}

// Most bodies may be static: they cost a step nothing.
void HalfSpaceTimes::set_due(BodyIndex body, Step due) {
  due_[body] = due;
  std::uint32_t& place = moving_places_[body];
  const bool moves = due != kNeverStep;
  if (moves == (place != kNoIndex)) return;
  if (moves) {
    place = static_cast<std::uint32_t>(moving_.size());
    moving_.push_back(body);
  } else {
    moving_[place] = moving_.back();
    moving_places_[moving_.back()] = place;
    moving_.pop_back();
    place = kNoIndex;
  }
}

void HalfSpaceTimes::update_again(BodyIndex body) {
  make_room(std::size_t{body} + 1);
  set_due(body, 0);
  if (halves_.size() > 0) next_ = 0;
}

void HalfSpaceTimes::update_all(std::size_t bodies) {
  make_room(bodies);
  for (const BodyIndex body : moving_) due_[body] = 0;
  next_ = 0;
}

void HalfSpaceTimes::forget(BodyIndex body) {
  make_room(std::size_t{body} + 1);
  set_due(body, kNeverStep);
}

void HalfSpaceTimes::due(Step now, std::vector<BodyIndex>& bodies) const {
  if (halves_.size() == 0 || next_ > now) return;
  for (const BodyIndex body : moving_) {
    if (due_[body] <= now) bodies.push_back(body);
  }
  if (!std::is_sorted(bodies.begin(), bodies.end())) std::sort(bodies.begin(), bodies.end());
}

void HalfSpaceTimes::update_windows(Step now, const Clock& clock, std::span<const BodyIndex> bodies,
                                    const BodyTable& table, std::span<const Motion> motions, double time_step,
                                    double slack, std::vector<BodyPair>& pairs) {
  slack_ = slack;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const BodyIndex body = bodies[k];
    Motion motion = motions[k];
    motion.radius += 2 * slack;  // one for where it is, one for where its bounds expect it
    bounds_[body] = {clock.time(now), motion, table.relies_on_middle(body, time_step)};
    if (!is_valid(motion)) {
      set_due(body, now + 1);
      continue;
    }
    double seconds = std::numeric_limits<double>::infinity();
    bool meets = false;
    halves_.each([&](const Body& of, const HalfSpace& half) {
      const double height = height_over(half, motion);
      seconds = std::min(seconds, seconds_above(half, motion, height));
      if (height > 0) return;
      meets = true;
      pairs.push_back({body, of.id.index});
    });
    const bool rests = table[body].frozen;
    const Step last = rests ? kNeverStep : clock.last_before_expiry(motion.expiry);
    const Step known = last >= kNeverStep - 1 ? kNeverStep - 1 : std::max(now, last) + 1;
    const Step free = clock.steps_before(std::min(seconds, 1e12 * time_step), now);
    const Step safe = now + std::max<Step>(1, free);
    set_due(body, meets ? now + 1 : std::min(known, safe));
  }
  next_ = kNeverStep;
  for (const BodyIndex body : moving_) next_ = std::min(next_, due_[body]);
}

bool HalfSpaceTimes::motion_bound_kept(BodyIndex body, double time, const Motion& now) const noexcept {
  if (halves_.size() == 0 || body >= due_.size() || due_[body] <= 0 || due_[body] == kNeverStep) return true;
  const MotionBound& bound = bounds_[body];
  return keeps_motion_bound(bound.motion, bound.time, time, now.position, nullptr, slack_) &&
         now.radius <= bound.motion.radius;
}

std::size_t HalfSpaceTimes::memory_bytes() const noexcept { return bytes_of(due_, bounds_, moving_, moving_places_); }

}  // namespace orchard::runtime::detail
