#include "broad_phase/near_pairs.h"

#include "broad_phase/horn.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMaxFloat = 0x1p120;       // what is below is finite in float
constexpr double kMinFloat = 0x1p-126;      // below, floats are rounded by more than their last place
constexpr double kEventResolution = 0.125;  // of a step: no need to know better when a pair can touch

}  // namespace

void InvalidBodies::refuse(BodyIndex body) {
  pool_.refuse(body);
  boxes_.take_away(body);
  windows_[body].end = kUpdateDue;
  windows_.void_events(body);
  overlaps_.mark(body, OverlapList::kUpdated);
  overlaps_.mark(body, OverlapList::kRefused);
  changes_.note(body);
}

// Where what is settled goes: at once,
struct NearPairs::Sink {
  NearPairs& of;
  bool may_pair(const BodyPair& pair) const { return of.pool_.may_pair(pair); }
  void touches(const BodyPair& pair) const { of.overlaps_.add(pair); }
  void parts(const BodyPair& pair) const { of.overlaps_.drop(pair); }
  void ahead(const BodyPair& pair) const { of.note_ahead(pair); }
  void doubtful(const PairEvent& event) const { of.doubtful_.push_back(event); }
  void later(const PairEvent& event, Step step) const { of.wheel_.add(event, step); }
  void refuses(BodyIndex body) const { of.refusals_.refuse(body); }
};

// or when all jobs are done: of new pairs, without a budget.
struct NearPairs::KeptSink {
  Outcome& outcome;
  static bool may_pair(const BodyPair&) { return true; }
  void touches(const BodyPair& pair) const { outcome.touching.push_back(pair); }
  static void parts(const BodyPair&) {}
  void ahead(const BodyPair& pair) const { outcome.ahead.push_back(pair); }
  static void doubtful(const PairEvent&) {}
  void later(const PairEvent& event, Step step) const { outcome.later.push_back({event, step}); }
  void refuses(BodyIndex body) const { outcome.refused.push_back(body); }
};

void NearPairs::begin_step(bool within_budget) {
  within_budget_ = within_budget;
  for (const PairEvent& event : doubtful_) overlaps_.drop(event.pair);
  doubtful_.clear();
}

// A pair that both have just been updated: true if nothing is to be done but what this does. It is found again at the
// end of the earlier window, and until then the spheres surely overlap, or surely do not.
template <typename To>
bool NearPairs::settle_by_spheres(Step now, const BodyPair& pair, To to) const {
  constexpr double kRounding = 0x1p-21;  // of the largest number, of two spheres: a float's last place eight times
  const Sphere &a = spheres_[pair.a], &b = spheres_[pair.b];
  double squared = 0, largest = double{a.radius} + b.radius;
  for (std::size_t d = 0; d < 3; ++d) {
    const double apart = double{b.center[d]} - a.center[d];
    squared += apart * apart;
    largest += std::fabs(double{a.center[d]}) + std::fabs(double{b.center[d]});
  }
  const double radii = double{a.radius} + b.radius, reach = double{a.reach} + b.reach,
               off = kRounding * largest + kMinFloat;
  if (!(largest < kMaxFloat)) return false;
  const auto below = [&](double length) { return length > 0 && squared < length * length; };
  const bool touching = below(radii - off);
  if (!touching && below(radii + off)) return false;  // as spheres_touch() says
  const bool over = std::min(windows_[pair.a].end, windows_[pair.b].end) <= now + 1;
  if (!touching) return over || !below(radii + reach + off);
  if (!over && !below(radii - reach - off)) return false;
  if (!to.may_pair(pair)) return true;
  if (ahead_) {
    to.ahead(pair);
  } else {
    to.touches(pair);
  }
  return true;
}

// What has been updated ahead is of the next step: this one has been reported already.
template <typename To>
void NearPairs::settle_touching(Step now, const PairEvent& event, Step left, Step sure, To to) const {
  const PairEvent next{event.pair, windows_.round(), !ahead_ || sure > 0};
  if (ahead_) {
    if (next.parting) to.ahead(event.pair);
  } else if (!event.parting) {
    to.touches(event.pair);
    if (within_budget_) to.doubtful(next);
  }
  // A pair with a body that waits is tested at the next step in any case.
  const bool waits = windows_[event.pair.a].end == kUpdateDue || windows_[event.pair.b].end == kUpdateDue;
  if (sure + 1 < left && !waits) to.later(next, now + sure + 1);
}

// For how many whole steps both motions hold, until the next update of one of them, or until a bound expires. Written
// where it stays: as a result it would be copied in pieces of another size than it was written in.
inline void NearPairs::find_horizon(Step now, const BodyPair& pair, const Motion& a, const Motion& b,
                                    Horizon& horizon) const noexcept {
  const Clock& clock = pool_.clock;
  const Step sooner = std::min(windows_.known_until(pair.a, now), windows_.known_until(pair.b, now));
  const Step left = std::min(sooner, now + kLongestWindow) - now;
  const double expiry = std::min(a.expiry, b.expiry);
  const bool in_time = expiry >= clock.time(now + left + 1);  // mostly, and sooner said
  const Step safe = in_time ? left : clock.last_before_expiry(expiry) - now;
  horizon.left = left;
  horizon.safe = safe;
  horizon.whole = std::max<Step>(0, std::min(left - 1, safe));
}

// They overlap, surely for a while, or they cannot for a while.
template <typename To>
void NearPairs::settle(Step now, const PairEvent& event, const Horizon& horizon, double limit, bool touching,
                       double seconds, To to) const {
  const Clock& clock = pool_.clock;
  if (touching) {
    const Step sure = seconds < limit ? clock.steps_within(seconds, now) : horizon.whole;
    return settle_touching(now, event, horizon.left, sure, to);
  }
  if (event.parting) to.parts(event.pair);
  if (horizon.left <= 1) return;
  Step ahead = seconds <= limit ? std::max<Step>(1, clock.steps_before(seconds, now)) : kNeverStep;
  if (horizon.safe < horizon.left) ahead = std::min(ahead, std::max<Step>(0, horizon.safe) + 1);
  if (ahead < horizon.left) to.later({event.pair, windows_.round()}, now + ahead);
}

// Those with a motion that is not valid leave; returns how many stay, at the front.
template <typename To>
std::size_t NearPairs::refuse_invalid(std::span<PairEvent> events, std::span<Motion> motions, To to) {
  std::size_t front = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Motion a = motions[2 * i], b = motions[2 * i + 1];
    const bool valid_a = is_valid(a), valid_b = is_valid(b);
    if (!valid_a) to.refuses(events[i].pair.a);
    if (!valid_b) to.refuses(events[i].pair.b);
    if (!valid_a || !valid_b) continue;
    events[front] = events[i];
    motions[2 * front] = a, motions[2 * front + 1] = b;
    ++front;
  }
  return front;
}

// Pair i, of at most kTestsAtOnce, has the motions 2 i and 2 i + 1 at this step.
template <typename To>
void NearPairs::settle_all(Step now, std::span<PairEvent> events, std::span<Motion> motions, To to) const {
  const double slack = 4 * options_.position_slack;  // of two bodies, now and later
  const double resolution = kEventResolution * options_.time_step;
  std::array<Horizon, kTestsAtOnce> horizons;
  std::array<double, kTestsAtOnce> limits;
  const auto find_horizons = [&] {
    for (std::size_t i = 0; i < events.size(); ++i) {
      find_horizon(now, events[i].pair, motions[2 * i], motions[2 * i + 1], horizons[i]);
      limits[i] = pool_.clock.seconds_between(now, now + horizons[i].whole);
    }
  };
  PairTimes times;
  find_horizons();
  if (!find_pair_times_at_once(motions.first(2 * events.size()), std::span(limits).first(events.size()), resolution,
                               slack, times)) {
    events = events.first(refuse_invalid(events, motions, to));
    find_horizons();
    find_pair_times(motions.first(2 * events.size()), std::span(limits).first(events.size()), resolution, slack, times);
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!to.may_pair(events[i].pair)) continue;  // what waited for its test while that changed
    settle(now, events[i], horizons[i], limits[i], times.touching[i], times.seconds[i], to);
  }
}

void NearPairs::test(Step now, std::span<PairEvent> events) {
  motions_.resize(2 * kTestsAtOnce);
  std::array<BodyIndex, 2 * kTestsAtOnce> bodies;
  while (!events.empty()) {
    const std::size_t count = std::min(kTestsAtOnce, events.size());
    for (std::size_t i = 0; i < count; ++i) {
      bodies[2 * i] = events[i].pair.a;
      bodies[2 * i + 1] = events[i].pair.b;
    }
    pool_.ask(now, std::span(bodies).first(2 * count), std::span(motions_).first(2 * count));
    settle_all(now, events.first(count), motions_, Sink{*this});
    events = events.subspan(count);
  }
}

void NearPairs::note_spheres(bool wanted, std::size_t slots) {
  constexpr std::uint64_t kTells = 64, kWorthIt = 4;  // pairs compared, and of so many one that is settled
  constexpr unsigned kInVain = 8;
  if (in_vain_ > 0) {
    --in_vain_;
  } else if (compared_ >= kTells && kWorthIt * settled_ < compared_) {
    in_vain_ = kInVain;
  }
  compared_ = settled_ = 0;
  wanted = wanted && in_vain_ == 0;
  if (wanted) {
    grow(spheres_, slots);
  } else {
    spheres_.clear();  // their room stays: the next plan may want them again
  }
}

void NearPairs::release_spheres() noexcept { give_back(spheres_); }

// Relative to the quantized grid, like that of every other body.
void NearPairs::note_sphere(BodyIndex body, const Motion& m, const QuantizedGrid& quantized_grid,
                            double duration) noexcept {
  constexpr double kOutward = 1 + 1e-6;  // for what is rounded here
  const Vec3 &origin = quantized_grid.origin(), &way = quantized_grid.velocity();
  const auto square = [](double x) { return x * x; };
  const double squares =
      square(m.velocity[0] - way[0]) + square(m.velocity[1] - way[1]) + square(m.velocity[2] - way[2]);
  const double travel = duration * (std::sqrt(squares) + m.drift + duration * m.acceleration / 2);
  const double reach = travel + motion_slack(m, m, duration) + 2 * options_.position_slack;
  Sphere& sphere = spheres_[body];
  for (std::size_t d = 0; d < 3; ++d) sphere.center[d] = static_cast<float>(m.position[d] - origin[d]);
  sphere.radius = static_cast<float>(m.radius);
  sphere.reach = static_cast<float>(reach * kOutward + kMinFloat);
}

void NearPairs::test_near(Step now, std::span<const BodyPair> pairs) {
  tests_.clear();
  const Round round = windows_.round();
  std::uint64_t compared = 0;
  for (const BodyPair& pair : pairs) {
    const bool known = !spheres_.empty() && windows_[pair.a].updated == round && windows_[pair.b].updated == round;
    compared += known;
    if (!known || !settle_by_spheres(now, pair, Sink{*this})) tests_.emplace_back(pair, round);
  }
  compared_ += compared;
  settled_ += pairs.size() - tests_.size();
  test(now, tests_);
}

void NearPairs::test_near(Step now, std::span<const BodyPair> pairs, Outcome& outcome) const {
  const KeptSink to{outcome};
  const Round round = windows_.round();
  std::uint64_t compared = 0;
  std::vector<PairEvent>& tests = outcome.tests;
  tests.clear();
  for (const BodyPair& pair : pairs) {
    const bool known = !spheres_.empty() && windows_[pair.a].updated == round && windows_[pair.b].updated == round;
    compared += known;
    if (!known || !settle_by_spheres(now, pair, to)) tests.emplace_back(pair, round);
  }
  outcome.compared += compared;
  outcome.settled += pairs.size() - tests.size();
  outcome.motions.resize(2 * kTestsAtOnce);
  std::array<BodyIndex, 2 * kTestsAtOnce> bodies;
  for (std::size_t done = 0; done < tests.size();) {
    const auto some = std::span(tests).subspan(done, std::min(kTestsAtOnce, tests.size() - done));
    done += some.size();
    for (std::size_t i = 0; i < some.size(); ++i) bodies[2 * i] = some[i].pair.a, bodies[2 * i + 1] = some[i].pair.b;
    const std::size_t count = 2 * some.size();
    pool_.ask(now, std::span(bodies).first(count), std::span(outcome.motions).first(count), outcome.answers);
    outcome.asked += count;
    settle_all(now, some, outcome.motions, to);
  }
}

void NearPairs::take(Outcome& outcome) {
  for (const BodyPair& pair : outcome.touching) overlaps_.add(pair);
  for (const Outcome::Later& later : outcome.later) wheel_.add(later.event, later.step);
  for (const BodyPair& pair : outcome.ahead) note_ahead(pair);
  for (const BodyIndex body : outcome.refused) refusals_.refuse(body);
  pool_.count_asked(outcome.asked);
  compared_ += outcome.compared;
  settled_ += outcome.settled;
  outcome.touching.clear(), outcome.later.clear(), outcome.ahead.clear(), outcome.refused.clear();
  outcome.asked = outcome.compared = outcome.settled = 0;
}

void NearPairs::take_overlaps_ahead() {
  for (const BodyPair& pair : overlaps_ahead_) {
    if (windows_.valid({pair, ahead_round_})) overlaps_.add(pair);
  }
  overlaps_ahead_.clear();
}

void NearPairs::take_overlaps_ahead(std::vector<PairEvent>& events) {
  for (const BodyPair& pair : overlaps_ahead_) events.emplace_back(pair, ahead_round_);
  overlaps_ahead_.clear();
}

// Of what was added in this step, the pairs of which no test has come after the last update of both bodies.
void NearPairs::keep_doubtful() {
  sure_.clear();
  for (const PairEvent& event : doubtful_) {
    if (windows_.valid(event)) sure_.push_back(event.pair);
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
  return bytes_of(spheres_) + bytes_of(overlaps_ahead_) + bytes_of(doubtful_) + bytes_of(tests_) + bytes_of(motions_) +
         bytes_of(sure_);
}

}  // namespace orchard::runtime::detail
