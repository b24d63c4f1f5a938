#include "events.h"
#include "horn.h"

// Testing near pairs: they overlap, or get an event.
namespace orchard::runtime::detail {
namespace {

constexpr double kEventResolution = 0.125;  // of a step: no need to know better when a pair can touch

}  // namespace

bool Events::valid(const PairEvent& event) const noexcept {
  return windows_[event.pair.a].looked <= event.created && windows_[event.pair.b].looked <= event.created;
}

void Events::test(Step now, std::span<const PairEvent> pairs) {
  motions_.resize(kBlock);
  std::array<BodyIndex, kBlock> bodies;
  while (!pairs.empty()) {
    const std::size_t count = std::min(kTestsAtOnce, pairs.size());
    for (std::size_t i = 0; i < count; ++i) {
      bodies[2 * i] = pairs[i].pair.a;
      bodies[2 * i + 1] = pairs[i].pair.b;
    }
    roster_.ask(now, std::span(bodies).first(2 * count), std::span(motions_).first(2 * count));
    for (std::size_t i = 0; i < count; ++i) {
      const Motion &a = motions_[2 * i], &b = motions_[2 * i + 1];
      const bool valid_a = is_valid(a), valid_b = is_valid(b);
      if (!valid_a) refuse(pairs[i].pair.a);
      if (!valid_b) refuse(pairs[i].pair.b);
      if (valid_a && valid_b) settle(now, pairs[i].pair, a, b);
    }
    pairs = pairs.subspan(count);
  }
}

// Up to the next look at the body. One that waits for it is known by its present motion only, which holds on its own.
Step Events::known_until(BodyIndex body, Step now) const noexcept {
  const Step end = windows_[body].end;
  return end == kLookDue ? now + kLongestWindow : end;
}

// Both motions are of this step: they overlap, surely for a while, or they cannot for a while.
void Events::settle(Step now, const BodyPair& pair, const Motion& a, const Motion& b) {
  if (!roster_.may_pair(pair)) return;  // what waited for its test while that changed
  const Clock& clock = roster_.clock;
  const double slack = 4 * options_.position_slack;  // of two bodies, now and later
  // Until the next look at one of them, or a bound expires.
  const Step safe = std::min(clock.last_before_expiry(a.expiry), clock.last_before_expiry(b.expiry)) - now;
  const Step left = std::min({known_until(pair.a, now), known_until(pair.b, now), now + kLongestWindow}) - now;
  const double seconds = static_cast<double>(std::max<Step>(0, std::min(left - 1, safe))) * options_.time_step;
  if (spheres_touch(a, b)) {
    if (prepared_round_ == round_) {  // reported already
      calendar_.add({pair, round_}, now + 1);
    } else {
      overlaps_.push_back({pair, round_, now + clock.steps_within(overlap_lasts(a, b, seconds, slack))});
    }
    return;
  }
  if (left <= 1) return;
  const double contact = earliest_contact(a, b, seconds, kEventResolution * options_.time_step, slack);
  Step ahead = contact <= seconds ? std::max<Step>(1, clock.steps_before(contact)) : kNeverStep;
  if (safe < left) ahead = std::min(ahead, std::max<Step>(0, safe) + 1);
  if (ahead < left) calendar_.add({pair, round_}, now + ahead);
}

}  // namespace orchard::runtime::detail
