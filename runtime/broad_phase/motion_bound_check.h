#pragma once
#include "orchard/runtime/broad_phase.h"

namespace orchard::runtime::detail {

inline constexpr Vec3 kNoVelocity{};

// Compares each motion that the source gives with the bounds that it gave before for the same body: those of the last
// motion, and the strictest ones that have not expired, because looser bounds do not replace stricter ones.
class MotionBoundCheck {
 public:
  MotionBoundCheck(MotionBoundViolationListener listener, double position_slack)
      : listener_(std::move(listener)), position_slack_(position_slack) {}

  // Checks a motion that the source has given at `time`, and calls the listener if it breaks a bound.
  void given(BodyId body, const Motion& motion, double time);
  void forget(BodyIndex body) noexcept;                      // the body has no bounds any more
  std::uint64_t broken() const noexcept { return broken_; }  // the number of violations
  std::size_t memory_bytes() const noexcept { return tracks_.capacity() * sizeof(Track); }

 private:
  struct MotionBound {
    bool made = false;
    double time = 0;
    Motion motion;
  };
  struct Track {
    MotionBound last, strictest;
    bool same = true;  // whether `last` and `strictest` are the same
  };
  bool kept(BodyId body, const MotionBound& bound, const Motion& motion, double time);

  MotionBoundViolationListener listener_;
  double position_slack_;
  std::vector<Track> tracks_;  // by body
  std::uint64_t broken_ = 0;
};

}  // namespace orchard::runtime::detail
