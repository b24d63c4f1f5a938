#include "broad_phase/motion_bound_check.h"

#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {
namespace {

// Returns whether a body that keeps the bounds of `newer` also keeps those of `older`.
bool implies(const Motion& newer, const Motion& older) noexcept {
  const bool any = dot(older.half_space, older.half_space) > 0;
  const bool side = !any || older.half_space == newer.half_space;
  return side && newer.acceleration <= older.acceleration && newer.drift <= older.drift && newer.expiry >= older.expiry;
}

}  // namespace

bool MotionBoundCheck::kept(BodyId body, const MotionBound& bound, const Motion& motion, double time) {
  if (!bound.made) return true;
  const MotionBoundExcess excess = motion_bound_excess(bound.motion, bound.time, motion, time, position_slack_);
  if (excess.none()) return true;
  ++broken_;
  if (listener_) listener_({body, bound.time, time, bound.motion, motion, excess});
  return false;
}

void MotionBoundCheck::given(BodyId body, const Motion& motion, double time) {
  grow(tracks_, std::size_t{body.index} + 1);
  Track& track = tracks_[body.index];
  if (!is_valid(motion)) {  // it is refused, so nothing relies on it or on earlier bounds
    track = {};
    return;
  }
  const bool all = kept(body, track.last, motion, time) && (track.same || kept(body, track.strictest, motion, time));
  const MotionBound& strictest = track.strictest;
  const bool over = !all || !strictest.made || time > strictest.motion.expiry;
  track.last = {true, time, motion};
  track.same = over || implies(motion, strictest.motion);
  if (track.same) track.strictest = track.last;
}

void MotionBoundCheck::forget(BodyIndex body) noexcept {
  if (body < tracks_.size()) tracks_[body] = {};
}

}  // namespace orchard::runtime::detail
