#include "broad_phase/near_pairs.h"

#include "broad_phase/horn.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kEventResolution = 0.125;  // of a step; the time of a contact need not be known better

}  // namespace

void KineticState::refuse(BodyIndex body) {
  pool.motions.refuse(body);
  boxes.take_away(body);
  windows[body].end = kUpdateDue;
  windows.void_events(body);
  overlaps.mark(body, OverlapList::kUpdated);
  overlaps.mark(body, OverlapList::kRefused);
  changes.note(body);
}

void NearPairs::begin_step(bool within_budget) {
  within_budget_ = within_budget;
  for (const PairEvent& event : doubtful_) state_.overlaps.drop(event.pair);
  doubtful_.clear();
}

// Decides a pair by the spheres that were noted when both bodies were updated in this round. Returns false if these do
// not suffice. Otherwise, the pair needs no event: it is found again at the end of the earlier window, and until then
// the spheres certainly overlap, or certainly do not.
bool NearPairs::settle_by_spheres(Step now, const BodyPair& pair, Outcome& outcome) const {
  const bool over = std::min(state_.windows[pair.a].end, state_.windows[pair.b].end) <= now + 1;
  const SphereNotes::Answer answer = spheres_.compare(pair, over);
  if (answer == SphereNotes::Answer::touching) (ahead_ ? outcome.ahead : outcome.touching).push_back(pair);
  return answer != SphereNotes::Answer::unknown;
}

// A test ahead is for the next step, because this one has been reported already.
void NearPairs::settle_touching(Step now, const PairEvent& event, Step left, Step sure, Outcome& outcome) const {
  const Round round = state_.windows.round();
  const bool parting = !ahead_ || sure > 0;
  if (ahead_) {
    if (parting) outcome.ahead.push_back(event.pair);
  } else if (!event.parting) {
    outcome.touching.push_back(event.pair);
    if (within_budget_) outcome.doubtful.emplace_back(event.pair, round, parting);
  }
  // A pair with a body that waits for its update is tested at the next step in any case.
  const bool waits = state_.windows[event.pair.a].end == kUpdateDue || state_.windows[event.pair.b].end == kUpdateDue;
  if (sure + 1 < left && !waits) outcome.later.emplace_back(event.pair, round, parting, now + sure + 1);
}

// Finds for how many whole steps both motions hold: until the next update of one of the bodies, or until a bound
// expires. The result is written where it stays. If it were returned, it would be copied in pieces of another size than
// it was written in, and would wait for these writes.
inline void NearPairs::find_horizon(Step now, const BodyPair& pair, const Motion& a, const Motion& b,
                                    Horizon& horizon) const noexcept {
  const Clock& clock = state_.pool.clock;
  const auto known_until = [&](BodyIndex body) {  // if the body waits for its update, only its motion sets a limit
    const Step end = state_.windows[body].end;
    return end == kUpdateDue ? now + kLongestWindow : end;
  };
  const Step sooner = std::min(known_until(pair.a), known_until(pair.b));
  const Step left = std::min(sooner, now + kLongestWindow) - now;
  const double expiry = std::min(a.expiry, b.expiry);
  const bool in_time = expiry >= clock.time(now + left + 1);  // mostly true, and faster to compute
  const Step safe = in_time ? left : clock.last_before_expiry(expiry) - now;
  horizon.left = left;
  horizon.safe = safe;
  horizon.whole = std::max<Step>(0, std::min(left - 1, safe));
}

// Records the result of a test, and when the pair has to be tested again. The bodies touch and certainly still overlap
// for `seconds`, or they cannot touch sooner than that.
void NearPairs::settle(Step now, const PairEvent& event, const Horizon& horizon, double limit, bool touching,
                       double seconds, Outcome& outcome) const {
  const Clock& clock = state_.pool.clock;
  if (touching) {
    const Step sure = seconds < limit ? clock.steps_within(seconds, now) : horizon.whole;
    return settle_touching(now, event, horizon.left, sure, outcome);
  }
  if (event.parting) outcome.parted.push_back(event.pair);
  if (horizon.left <= 1) return;
  Step ahead = seconds <= limit ? std::max<Step>(1, clock.steps_before(seconds, now)) : kNeverStep;
  if (horizon.safe < horizon.left) ahead = std::min(ahead, std::max<Step>(0, horizon.safe) + 1);
  if (ahead < horizon.left) outcome.later.emplace_back(event.pair, state_.windows.round(), false, now + ahead);
}

// Refuses bodies whose motions are not valid, and removes their pairs. Returns how many pairs stay, at the front.
std::size_t NearPairs::refuse_invalid(std::span<PairEvent> events, std::span<Motion> motions, Outcome& outcome) {
  std::size_t front = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Motion a = motions[2 * i], b = motions[2 * i + 1];
    const bool valid_a = is_valid(a), valid_b = is_valid(b);
    if (!valid_a) outcome.refused.push_back(events[i].pair.a);
    if (!valid_b) outcome.refused.push_back(events[i].pair.b);
    if (!valid_a || !valid_b) continue;
    events[front] = events[i];
    motions[2 * front] = a, motions[2 * front + 1] = b;
    ++front;
  }
  return front;
}

// Tests at most kTestsAtOnce pairs. Pair i has the motions 2 i and 2 i + 1 of `outcome`, which are those at this step.
void NearPairs::settle_all(Step now, std::span<PairEvent> events, Outcome& outcome) const {
  const std::span<Motion> motions = outcome.motions;
  PairPrecision precision{kEventResolution * state_.options.time_step,
                          4 * state_.options.position_slack};  // for two bodies, now and later
  std::array<Horizon, kTestsAtOnce> horizons;
  std::array<double, kTestsAtOnce> limits;
  PairTimes times;
  const auto find = [&] {
    for (std::size_t i = 0; i < events.size(); ++i) {
      find_horizon(now, events[i].pair, motions[2 * i], motions[2 * i + 1], horizons[i]);
      limits[i] = state_.pool.clock.seconds_between(now, now + horizons[i].whole);
    }
    return find_pair_times(motions.first(2 * events.size()), std::span(limits).first(events.size()), precision, times);
  };
  if (!find()) {
    events = events.first(refuse_invalid(events, motions, outcome));
    precision.valid = true;
    find();
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    settle(now, events[i], horizons[i], limits[i], times.touching[i], times.seconds[i], outcome);
  }
}

void NearPairs::test(Step now, std::span<PairEvent> events, Outcome& outcome) const {
  outcome.motions.resize(2 * kTestsAtOnce);
  std::array<BodyIndex, 2 * kTestsAtOnce> bodies;
  while (!events.empty()) {
    const auto some = events.first(std::min(kTestsAtOnce, events.size()));
    const std::size_t count = 2 * some.size();
    for (std::size_t i = 0; i < some.size(); ++i) bodies[2 * i] = some[i].pair.a, bodies[2 * i + 1] = some[i].pair.b;
    state_.pool.motions.ask(now, std::span(bodies).first(count), std::span(outcome.motions).first(count),
                            outcome.answers);
    outcome.asked += count;
    settle_all(now, some, outcome);
    events = events.subspan(some.size());
  }
}

void NearPairs::test(Step now, std::span<PairEvent> events) {
  if (state_.pool.filters_pairs()) {  // which may have changed while the pairs waited for their test
    const auto excluded = [this](const PairEvent& event) { return !state_.pool.may_pair(event.pair); };
    const auto end = std::remove_if(events.begin(), events.end(), excluded);
    events = events.first(static_cast<std::size_t>(end - events.begin()));
  }
  test(now, events, own_);
  take(own_);
}

void NearPairs::test_near(Step now, std::span<const BodyPair> pairs, Outcome& outcome) const {
  const Round round = state_.windows.round();
  outcome.tests.clear();
  for (const BodyPair& pair : pairs) {
    const bool known =
        spheres_.any() && state_.windows[pair.a].updated == round && state_.windows[pair.b].updated == round;
    if (!known || !settle_by_spheres(now, pair, outcome)) outcome.tests.emplace_back(pair, round);
  }
  test(now, outcome.tests, outcome);
}

void NearPairs::test_near(Step now, std::span<const BodyPair> pairs) {
  constexpr std::size_t kAtOnce = 1024;  // so that the outcome is still in the cache when it is applied
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(kAtOnce, pairs.size()))) {
    test_near(now, pairs.first(std::min(kAtOnce, pairs.size())), own_);
    take(own_);
  }
}

void NearPairs::take(Outcome& outcome) {
  for (const BodyPair& pair : outcome.touching) state_.overlaps.add(pair);
  for (const BodyPair& pair : outcome.parted) state_.overlaps.drop(pair);
  for (const Outcome::Later& later : outcome.later) state_.wheel.add(later.event, later.step);
  if (!outcome.ahead.empty()) ahead_round_ = state_.windows.round();
  for (const BodyPair& pair : outcome.ahead) append(overlaps_ahead_, pair);
  doubtful_.insert(doubtful_.end(), outcome.doubtful.begin(), outcome.doubtful.end());
  for (const BodyIndex body : outcome.refused) state_.refuse(body);
  state_.pool.motions.count_asked(outcome.asked);
  outcome.touching.clear(), outcome.parted.clear(), outcome.later.clear(), outcome.ahead.clear();
  outcome.doubtful.clear(), outcome.refused.clear();
  outcome.asked = 0;
}

void NearPairs::take_overlaps_ahead() {
  for (const BodyPair& pair : overlaps_ahead_) {
    if (state_.windows.valid({pair, ahead_round_})) state_.overlaps.add(pair);
  }
  overlaps_ahead_.clear();
}

void NearPairs::take_overlaps_ahead(std::vector<PairEvent>& events) {
  for (const BodyPair& pair : overlaps_ahead_) events.emplace_back(pair, ahead_round_);
  overlaps_ahead_.clear();
}

// Keeps those overlaps of this step as doubtful that no test has confirmed since the last updates of both bodies.
void NearPairs::keep_doubtful() {
  sure_.clear();
  for (const PairEvent& event : doubtful_) {
    if (state_.windows.valid(event)) sure_.push_back(event.pair);
  }
  std::sort(sure_.begin(), sure_.end());
  std::erase_if(doubtful_,
                [&](const PairEvent& event) { return std::binary_search(sure_.begin(), sure_.end(), event.pair); });
  sure_.clear();
}

void NearPairs::forget_all() noexcept {
  overlaps_ahead_.clear();
  doubtful_.clear();
}

std::size_t NearPairs::memory_bytes() const noexcept {
  return spheres_.memory_bytes() + bytes_of(overlaps_ahead_, doubtful_) + own_.memory_bytes() + bytes_of(sure_);
}

}  // namespace orchard::runtime::detail
