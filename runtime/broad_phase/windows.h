#pragma once
#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

inline constexpr Step kUpdateDue = -1;  // a window's end while its body waits for a window update
inline constexpr std::uint8_t kLastsAsEver = static_cast<std::uint8_t>(kLongestWindow - 1);

struct Window {
  Step end = 0;                         // the step of the next update
  Round updated = 0;                    // the round of the last update: events of earlier rounds are void
  std::uint8_t length = 0;              // steps; 0: not known; of a window without end as if it were the longest one
  std::uint8_t lasting = kLastsAsEver;  // steps that bounds are relied on for, at most
  std::uint16_t began = 0;              // the last bits of the step

  void rely_longer() noexcept { lasting = lasting < kLastsAsEver / 4 ? lasting * 4 : kLastsAsEver; }
};

// It will never move, unless it is cancelled.
inline bool rests(const Motion& motion) noexcept {
  return motion.expiry == std::numeric_limits<double>::infinity() && motion.velocity == kNoVelocity &&
         motion.acceleration == 0 && motion.drift == 0;
}

// How long windows are.
struct WindowRule {
  struct LastEnd {  // what was asked last is mostly asked again
    Step from = -1, end = 1;
    double expiry = 0;
  };
  // The first step at which the bound does not hold or which another update is due at.
  Step end_of(Step from, const Motion& motion, LastEnd& last) const noexcept;
  // The same for the window of a body, whose bounds may have been cancelled again and again.
  Step end_of(Step from, const Window& window, bool is_static, const Motion& motion, LastEnd& last) const noexcept;

  const Clock& clock;
  Step fixed;              // 0, or the most steps that a window has
  Step planned = 1;        // steps
  bool all_end = false;    // also windows of bodies at rest; else these never do
  bool any_short = false;  // of bodies whose bounds are cancelled again and again
};

// The step at which the most windows end, if these are many.
class WindowVotes {
 public:
  void vote(Step end, std::size_t bodies) noexcept;
  Step voted() const noexcept { return voted_; }
  std::size_t votes() const noexcept { return votes_; }

 private:
  Step voted_ = kNeverStep;
  std::size_t votes_ = 0;
};

// Of each body, up to when the bounds it was asked for are relied on, and the rounds in which windows are updated.
class Windows {
 public:
  Windows(const BodyPool& pool, Step fixed) : pool_(pool), rule_{pool.clock, fixed} {}

  void make_room(std::size_t slots) { grow(windows_, slots); }
  std::size_t size() const noexcept { return windows_.size(); }
  Window& operator[](BodyIndex body) noexcept { return windows_[body]; }
  const Window& operator[](BodyIndex body) const noexcept { return windows_[body]; }

  Round round() const noexcept { return round_; }
  void begin_round() noexcept { ++round_; }
  void start_over() noexcept;  // all are updated in this round
  bool rounds_run_out() const noexcept { return is_later(round_, rebuilt_round_ + kFarthestRound); }

  void plan(Step window, bool all_end) noexcept { rule_.planned = window, rule_.all_end = all_end; }  // from now on
  const WindowRule& rule() const noexcept { return rule_; }
  WindowVotes& votes() noexcept { return votes_; }  // since start_over()
  void set(BodyIndex body, Step from, Step end) noexcept {
    const std::uint8_t length = end != kNeverStep         ? static_cast<std::uint8_t>(end - from)
                                : pool_.statics.has(body) ? std::uint8_t{0}
                                                          : kLastsAsEver;
    set(windows_[body], from, end, length, round_);
  }
  void set(std::span<const BodyIndex> bodies, Step from, std::span<const Step> ends) noexcept {
    for (std::size_t i = 0; i < bodies.size(); ++i) set(bodies[i], from, ends[i]);
  }
  void set_alike(std::span<const BodyIndex> bodies, Step from, Step end) noexcept {  // which is not never
    Window* const windows = windows_.data();
    const auto length = static_cast<std::uint8_t>(end - from);
    const Round round = round_;
    for (const BodyIndex body : bodies) set(windows[body], from, end, length, round);
  }

  bool valid(const PairEvent& event) const noexcept {
    const Round created = event.created;
    return !is_later(windows_[event.pair.a].updated, created) && !is_later(windows_[event.pair.b].updated, created);
  }
  void void_events(BodyIndex body) noexcept {
    windows_[body].updated = round_ + 1;
    windows_[body].length = 0;
  }
  // Up to the next update of its window. One that waits for it is known by its present motion only, which holds on its
  // own.
  Step known_until(BodyIndex body, Step now) const noexcept {
    const Step end = windows_[body].end;
    return end == kUpdateDue ? now + kLongestWindow : end;
  }
  bool note_cancelled(BodyIndex body, Step now) noexcept {  // false if it had no bounds yet
    const Window& window = windows_[body];
    if (window.length == 0 || window.end < 0) return false;
    note_lasting(body, now);
    return true;
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(windows_); }

 private:
  static void set(Window& window, Step from, Step end, std::uint8_t length, Round round) noexcept {
    window.end = end;
    window.updated = round;
    window.began = static_cast<std::uint16_t>(from);
    window.length = length;
  }
  void note_lasting(BodyIndex body, Step now) noexcept;

  const BodyPool& pool_;
  WindowRule rule_;
  std::vector<Window> windows_;  // by body
  Round round_ = 0, rebuilt_round_ = 0;
  WindowVotes votes_;
};

}  // namespace orchard::runtime::detail
