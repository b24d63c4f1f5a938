#pragma once
#include "orchard/runtime/broad_phase.h"

namespace orchard::runtime::detail {

// Compares each motion that is given with what was promised for the same body before: in the motion given last, and in
// the strictest one that is still in force, as a looser one does not take that back.
class MotionBoundCheck {
 public:
  MotionBoundCheck(MotionBoundViolationListener listener, double position_slack)
      : listener_(std::move(listener)), position_slack_(position_slack) {}

  void given(BodyId body, const Motion& motion, double time);
  void forget(BodyIndex body) noexcept;  // nothing is promised any more
  std::uint64_t broken() const noexcept { return broken_; }
  std::size_t memory_bytes() const noexcept { return tracks_.capacity() * sizeof(Track); }

 private:
  struct MotionBound {
    bool made = false;
    double time = 0;
    Motion motion;
  };
  struct Track {
    MotionBound last, strictest;
    bool same = true;  // the two
  };
  bool kept(BodyId body, const MotionBound& bound, const Motion& motion, double time);

  MotionBoundViolationListener listener_;
  double position_slack_;
  std::vector<Track> tracks_;  // by body
  std::uint64_t broken_ = 0;
};

}  // namespace orchard::runtime::detail
