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

void NearPairs::begin_step(bool within_budget) {
  within_budget_ = within_budget;
  for (const PairEvent& event : doubtful_) overlaps_.drop(event.pair);
  doubtful_.clear();
}

// A pair that both have just been updated: true if nothing is to be done but what this does. It is found again at the
// end of the earlier window, and until then the spheres surely overlap, or surely do not.
bool NearPairs::settle_by_spheres(Step now, const BodyPair& pair, Outcome& outcome) const {
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
  (ahead_ ? outcome.ahead : outcome.touching).push_back(pair);
  return true;
}

// What has been updated ahead is of the next step: this one has been reported already.
void NearPairs::settle_touching(Step now, const PairEvent& event, Step left, Step sure, Outcome& outcome) const {
  const PairEvent next{event.pair, windows_.round(), !ahead_ || sure > 0};
  if (ahead_) {
    if (next.parting) outcome.ahead.push_back(event.pair);
  } else if (!event.parting) {
    outcome.touching.push_back(event.pair);
    if (within_budget_) outcome.doubtful.push_back(next);
  }
  // A pair with a body that waits is tested at the next step in any case.
  const bool waits = windows_[event.pair.a].end == kUpdateDue || windows_[event.pair.b].end == kUpdateDue;
  if (sure + 1 < left && !waits) outcome.later.push_back({next, now + sure + 1});
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
void NearPairs::settle(Step now, const PairEvent& event, const Horizon& horizon, double limit, bool touching,
                       double seconds, Outcome& outcome) const {
  const Clock& clock = pool_.clock;
  if (touching) {
    const Step sure = seconds < limit ? clock.steps_within(seconds, now) : horizon.whole;
    return settle_touching(now, event, horizon.left, sure, outcome);
  }
  if (event.parting) outcome.parted.push_back(event.pair);
  if (horizon.left <= 1) return;
  Step ahead = seconds <= limit ? std::max<Step>(1, clock.steps_before(seconds, now)) : kNeverStep;
  if (horizon.safe < horizon.left) ahead = std::min(ahead, std::max<Step>(0, horizon.safe) + 1);
  if (ahead < horizon.left) outcome.later.push_back({{event.pair, windows_.round()}, now + ahead});
}

// Those with a motion that is not valid leave; returns how many stay, at the front.
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

// Pair i, of at most kTestsAtOnce, has the motions 2 i and 2 i + 1 at this step.
void NearPairs::settle_all(Step now, std::span<PairEvent> events, Outcome& outcome) const {
  const std::span<Motion> motions = outcome.motions;
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
    events = events.first(refuse_invalid(events, motions, outcome));
    find_horizons();
    find_pair_times(motions.first(2 * events.size()), std::span(limits).first(events.size()), resolution, slack, times);
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
    pool_.ask(now, std::span(bodies).first(count), std::span(outcome.motions).first(count), outcome.answers);
    outcome.asked += count;
    settle_all(now, some, outcome);
    events = events.subspan(some.size());
  }
}

void NearPairs::test(Step now, std::span<PairEvent> events) {
  if (pool_.filters_pairs()) {  // which may have changed while the pairs waited for their test
    const auto excluded = [this](const PairEvent& event) { return !pool_.may_pair(event.pair); };
    const auto end = std::remove_if(events.begin(), events.end(), excluded);
    events = events.first(static_cast<std::size_t>(end - events.begin()));
  }
  test(now, events, own_);
  take(own_);
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

void NearPairs::test_near(Step now, std::span<const BodyPair> pairs, Outcome& outcome) const {
  const Round round = windows_.round();
  outcome.tests.clear();
  std::uint64_t compared = 0;
  for (const BodyPair& pair : pairs) {
    const bool known = !spheres_.empty() && windows_[pair.a].updated == round && windows_[pair.b].updated == round;
    compared += known;
    if (!known || !settle_by_spheres(now, pair, outcome)) outcome.tests.emplace_back(pair, round);
  }
  outcome.compared += compared;
  outcome.settled += pairs.size() - outcome.tests.size();
  test(now, outcome.tests, outcome);
}

void NearPairs::test_near(Step now, std::span<const BodyPair> pairs) {
  constexpr std::size_t kAtOnce = 1024;  // so that what is known of them is still in the cache when it is taken over
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(kAtOnce, pairs.size()))) {
    test_near(now, pairs.first(std::min(kAtOnce, pairs.size())), own_);
    take(own_);
  }
}

void NearPairs::take(Outcome& outcome) {
  for (const BodyPair& pair : outcome.touching) overlaps_.add(pair);
  for (const BodyPair& pair : outcome.parted) overlaps_.drop(pair);
  for (const Outcome::Later& later : outcome.later) wheel_.add(later.event, later.step);
  if (!outcome.ahead.empty()) ahead_round_ = windows_.round();
  for (const BodyPair& pair : outcome.ahead) append(overlaps_ahead_, pair);
  doubtful_.insert(doubtful_.end(), outcome.doubtful.begin(), outcome.doubtful.end());
  for (const BodyIndex body : outcome.refused) refusals_.refuse(body);
  pool_.count_asked(outcome.asked);
  compared_ += outcome.compared;
  settled_ += outcome.settled;
  outcome.touching.clear(), outcome.parted.clear(), outcome.later.clear(), outcome.ahead.clear();
  outcome.doubtful.clear(), outcome.refused.clear();
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
  return bytes_of(spheres_, overlaps_ahead_, doubtful_) + own_.memory_bytes() + bytes_of(sure_);
}

}  // namespace orchard::runtime::detail
