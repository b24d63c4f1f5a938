#include "broad_phase/windows.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kLongerWindow = 0.4;  // a window may exceed the plan's by as much of it: one update, not two
constexpr std::uint8_t kPatience = 2;  // bounds that last for a step at most, one after the other, that mean nothing

}  // namespace

void Windows::start_over() noexcept {
  rebuilt_round_ = round_;
  rule_.any_short = rule_.any_short && std::any_of(windows_.begin(), windows_.end(),
                                                   [](const Window& window) { return window.lasting < kLastsAsEver; });
  votes_ = {};
}

// Until a bound expires windows are equal parts.
Step WindowRule::end_of(Step from, const Motion& motion, LastEnd& before) const noexcept {
  if (from == before.from && motion.expiry == before.expiry) return before.end;
  const Step last = clock.last_before_expiry(motion.expiry);
  Step window = planned;
  if (last < from + 64 * planned) {
    const double steps = static_cast<double>(std::max<Step>(0, last - from) + 1);
    const double longer = fixed > 0 ? 0 : kLongerWindow;
    const double parts = std::max(1.0, std::ceil(steps / static_cast<double>(planned) - longer));
    window = std::min(kLongestWindow - 1, static_cast<Step>(std::ceil(steps / parts)));
  }
  before = {from, from + window, motion.expiry};
  return before.end;
}

Step WindowRule::end_of(Step from, const Window& window, bool is_static, const Motion& motion,
                        LastEnd& last) const noexcept {
  if (!all_end && (is_static || (rests(motion) && window.lasting == kLastsAsEver))) return kNeverStep;
  const Step end = end_of(from, motion, last);
  return any_short ? std::min(end, from + window.lasting) : end;
}

// Its bounds have ended before their time. Now and then that says nothing of the next ones, which may hold for as long
// as any. Only where bounds last for no more than a step again and again a long window is of no use.
void Windows::note_lasting(BodyIndex body, Step now) noexcept {
  Window& window = windows_[body];
  const Step lasted = window.end == kNeverStep
                          ? static_cast<std::uint16_t>(static_cast<std::uint16_t>(now) - window.began)
                          : now - (window.end - window.length);
  if (lasted > 1) window.rely_longer();
  if (lasted < 0 || lasted > 1) return;
  window.lasting = window.lasting > kLastsAsEver - kPatience ? window.lasting - 1 : 1;
  rule_.any_short = rule_.any_short || window.lasting == 1;
}

// The majority's vote, if there is one: what differs is paired off.
void WindowVotes::vote(Step end, std::size_t bodies) noexcept {
  if (end == voted_) {
    votes_ += bodies;
  } else if (bodies > votes_) {
    voted_ = end;
    votes_ = bodies - votes_;
  } else {
    votes_ -= bodies;
  }
}

}  // namespace orchard::runtime::detail
