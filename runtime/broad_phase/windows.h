#pragma once
#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

inline constexpr Step kUpdateDue = -1;  // a window's end while its body waits for a window update

struct Window {
  Step end = 0;          // the step of the next update
  Round updated = 0;     // the round of the last update: events of earlier rounds are void
  bool bounded = false;  // whether bounds are relied on, which may be cancelled; not of static bodies
  bool listed = false;   // its end was the same before: the wheel has the body there
};

// It will never move, unless it is cancelled.
inline bool rests(const Motion& motion) noexcept {
  return motion.expiry == std::numeric_limits<double>::infinity() && motion.velocity == kNoVelocity &&
         motion.acceleration == 0 && motion.drift == 0;
}

// Of each body, up to when the bounds it was asked for are relied on, and the rounds in which windows are updated.
class Windows {
 public:
  // fixed: 0, or the most steps that a window has.
  Windows(const BodyPool& pool, Step fixed) : pool_(pool), fixed_(fixed) {}

  void make_room(std::size_t slots) { grow(windows_, slots); }
  std::size_t size() const noexcept { return windows_.size(); }
  Window& operator[](BodyIndex body) noexcept { return windows_[body]; }
  const Window& operator[](BodyIndex body) const noexcept { return windows_[body]; }

  Round round() const noexcept { return round_; }
  void begin_round() noexcept { ++round_; }
  void start_over() noexcept { rebuilt_round_ = round_; }  // all are updated in this round
  bool rounds_run_out() const noexcept { return is_later(round_, rebuilt_round_ + kFarthestRound); }

  // From now on windows have about so many steps; all_end: also those of bodies at rest, which else never end.
  void plan(Step steps, bool all_end) noexcept { planned_ = steps, all_end_ = all_end; }
  // The first step at which the bound of a body does not hold or which another update is due at.
  Step end_of(Step from, BodyIndex body, const Motion& motion) const noexcept;
  void set(BodyIndex body, Step end) noexcept {
    Window& window = windows_[body];
    const bool listed = rebuilt_round_ != round_ && window.end == end && !is_later(rebuilt_round_, window.updated);
    window = {end, round_, !pool_.statics.has(body), listed};
  }

  bool valid(const PairEvent& event) const noexcept {
    const Round created = event.created;
    return !is_later(windows_[event.pair.a].updated, created) && !is_later(windows_[event.pair.b].updated, created);
  }
  void void_events(BodyIndex body) noexcept { windows_[body].updated = round_ + 1, windows_[body].bounded = false; }
  std::size_t memory_bytes() const noexcept { return bytes_of(windows_); }

 private:
  const BodyPool& pool_;
  Step fixed_, planned_ = 1;
  bool all_end_ = false;
  std::vector<Window> windows_;  // by body
  Round round_ = 0, rebuilt_round_ = 0;
};

}  // namespace orchard::runtime::detail
