#pragma once
#include "detector/bodies.h"

namespace orchard::runtime::detail {

// The half-spaces of a world. They are few, and static.
class HalfSpaces {
 public:
  BodyIndex add(const HalfSpace& half, const Body& with);  // returns its index; its generation is 1
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

// The first step at which each body can reach a half-space, by the same motion bounds as those of the broad phase. At
// that step, the body is due: its pairs and its next step are found again. One step is kept per body, whatever the
// number of half-spaces, because they are few.
class HalfSpaceTimes {
 public:
  explicit HalfSpaceTimes(const HalfSpaces& halves) noexcept : halves_(halves) {}

  // Makes a body due at the next step, because it is new or its motion bounds do not hold any more.
  void update_again(BodyIndex body) { set_due(body, 0); }
  void update_all() noexcept;                                 // makes all bodies due, for a new half-space
  void forget(BodyIndex body) { set_due(body, kNeverStep); }  // after it was removed, or for one that does not move
  // Returns the first step at which a body is due, or kNeverStep.
  Step next() const noexcept { return halves_.empty() ? kNeverStep : next_; }

  // Appends the bodies that are due at `now` or before, in ascending order. The caller then has to call update() for
  // each of them.
  void due(Step now, std::vector<BodyIndex>& bodies);
  // Appends the pairs of a body, in ascending order of half-spaces, and computes when it is due again. `motion` is the
  // motion bound of the body. `slack`: see BroadPhaseOptions::position_slack.
  void update(const Body& body, Step now, const Clock& clock, Motion motion, double slack,
              std::vector<BodyPair>& pairs);
  // Returns whether the body, whose motion at `time` is `now`, keeps the motion bound from which its next due step was
  // computed.
  bool motion_bound_kept(BodyIndex body, double time, const Motion& now) const noexcept;
  // Returns whether that bound is about the body's middle; see Body::relies_on_middle().
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
  std::vector<BodyIndex> moving_;    // the bodies that move, in ascending order
  bool moving_known_ = true;         // `moving_` is up to date
  std::vector<MotionBound> bounds_;  // by body
  double slack_ = 0;
  Step next_ = kNeverStep;
};

}  // namespace orchard::runtime::detail
