#pragma once
#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

inline constexpr Step kUpdateDue = -1;  // a window's end while its body waits for a window update

// The window of a body: the steps for which its box holds.
struct Window {
  Step end = 0;          // the step of the next update
  Round updated = 0;     // the round of the last update: events of earlier rounds are void
  bool bounded = false;  // whether it relies on bounds that may be cancelled; false for static bodies
  bool listed = false;   // the timing wheel has the body at `end` already, from an earlier update
};

// Returns whether a body with this motion never moves, unless its bounds are cancelled.
inline bool rests(const Motion& motion) noexcept {
  return motion.expiry == std::numeric_limits<double>::infinity() && motion.velocity == kNoVelocity &&
         motion.acceleration == 0 && motion.drift == 0;
}

// The windows of all bodies, and the count of the rounds of window updates.
class Windows {
 public:
  // `fixed` is the maximum number of steps of a window, or 0 if the plan chooses it.
  Windows(const BodyPool& pool, Step fixed) : pool_(pool), fixed_(fixed) {}

  void make_room(std::size_t slots) { grow(windows_, slots); }
  std::size_t size() const noexcept { return windows_.size(); }
  Window& operator[](BodyIndex body) noexcept { return windows_[body]; }
  const Window& operator[](BodyIndex body) const noexcept { return windows_[body]; }

  Round round() const noexcept { return round_; }
  void begin_round() noexcept { ++round_; }
  void start_over() noexcept { rebuilt_round_ = round_; }  // all windows are updated in this round
  bool rounds_run_out() const noexcept { return is_later(round_, rebuilt_round_ + kFarthestRound); }

  // Sets the approximate number of steps of further windows. `all_end`: the windows of bodies at rest end, too;
  // otherwise, they never end.
  void plan(Step steps, bool all_end) noexcept { planned_ = steps, all_end_ = all_end; }
  // Returns the end of a window that begins at `from`: the first step at which the motion bound does not hold or the
  // next update is due.
  Step end_of(Step from, BodyIndex body, const Motion& motion) const noexcept;
  void set(BodyIndex body, Step end) noexcept {
    Window& window = windows_[body];
    const bool listed = rebuilt_round_ != round_ && window.end == end && !is_later(rebuilt_round_, window.updated);
    window = {end, round_, !pool_.statics.has(body), listed};
  }

  // Returns whether an event is not void: neither body has been updated in a round after that of the event.
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
