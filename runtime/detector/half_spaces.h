#pragma once
#include "detector/bodies.h"

namespace orchard::runtime::detail {

// The half-spaces of a world: few, and static.
class HalfSpaces {
 public:
  BodyIndex add(const HalfSpace& half, const Body& with);  // its BodyIndex; BodyId::generation is 1
  bool remove(BodyIndex index) noexcept;
  bool contains(BodyId id) const noexcept {
    return is_half_space(id.index) && id.generation == 1 && id.index - kFirstHalfSpace < planes_.size() &&
           body(id.index).id == id;
  }
  const Shape& shape(BodyIndex index) const noexcept { return planes_[index - kFirstHalfSpace].shape; }
  Body& body(BodyIndex index) noexcept { return planes_[index - kFirstHalfSpace].body; }
  const Body& body(BodyIndex index) const noexcept { return planes_[index - kFirstHalfSpace].body; }
  bool empty() const noexcept {
    return std::all_of(planes_.begin(), planes_.end(), [](const Plane& plane) { return plane.body.id == kNoBody; });
  }
  template <typename Visit>
  void each(Visit&& visit) const {  // visit(body, shape)
    for (const Plane& plane : planes_) {
      if (plane.body.id != kNoBody) visit(plane.body, plane.shape);
    }
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(planes_); }

 private:
  struct Plane {
    Shape shape;
    Body body;
  };
  std::vector<Plane> planes_;
};

// When each body can reach a half-space at the earliest, from the same bounds as the broad phase's; at that step it is
// updated again. One number per body, whatever the number of half-spaces: they are few.
class HalfSpaceTimes {
 public:
  explicit HalfSpaceTimes(const HalfSpaces& halves) noexcept : halves_(halves) {}

  // At the next step: it is new, or its bounds do not hold any more.
  void update_again(BodyIndex body) { set_due(body, 0); }
  void update_all() noexcept;                                 // a half-space is new
  void forget(BodyIndex body) { set_due(body, kNeverStep); }  // it is gone, or does not move
  // At which any body is due.
  Step next() const noexcept { return halves_.empty() ? kNeverStep : next_; }

  // The bodies due at `now` or before, in ascending order, each of which is to be updated.
  void due(Step now, std::vector<BodyIndex>& bodies);
  // Of a body of which `motion` is relied on: appends its pairs, in ascending order of half-spaces, and finds when it
  // is due again. `slack`: see BroadPhaseOptions::position_slack.
  void update(const Body& body, Step now, const Clock& clock, Motion motion, double slack,
              std::vector<BodyPair>& pairs);
  // Whether the body keeps the bounds that its next update relies on.
  bool motion_bound_kept(BodyIndex body, double time, const Motion& now) const noexcept;
  // Whether that is about the body's middle: see Body::relies_on_middle().
  bool relies_on_middle(BodyIndex body) const noexcept { return body < bounds_.size() && bounds_[body].by_middle; }
  std::size_t memory_bytes() const noexcept { return bytes_of(due_, moving_, bounds_); }

 private:
  struct MotionBound {
    double time = 0;
    Motion motion;
    bool by_middle = false;
  };
  void set_due(BodyIndex body, Step due);
  const HalfSpaces& halves_;
  std::vector<Step> due_;            // by body; kNeverStep: it does not move
  std::vector<BodyIndex> moving_;    // in ascending order: all but those that do not move,
  bool moving_known_ = true;         // unless some have come or gone
  std::vector<MotionBound> bounds_;  // by body
  double slack_ = 0;
  Step next_ = kNeverStep;
};

}  // namespace orchard::runtime::detail
