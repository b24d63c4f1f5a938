#include "events.h"

#include "horn.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kMeansStride = 16;    // of the bodies looked at, every so many count for the plan's means
constexpr std::size_t kChangesKept = 1024;  // room for as many changes in a step stays allocated
constexpr Step kLookDue = -1;               // a window's end while its body waits for a look
constexpr double kEventResolution = 0.125;  // of a step: no need to know better when a pair can touch

bool cells_fit(const QuantumBox& box) noexcept {
  bool fit = true;
  for (std::size_t d = 0; d < 3; ++d) {
    fit = fit && (box.upper[d] >> kQuantumBits) - (box.lower[d] >> kQuantumBits) < kMostCellsPerAxis;
  }
  return fit;
}

}  // namespace

void Events::make_room() {
  const std::size_t n = roster_.slots();
  if (windows_.size() >= n) return;
  grow(boxes_, n);
  grow(windows_, n);
  grow(places_, n);
  grow(pending_, n);
}

void Events::changed(BodyId body) {
  make_room();
  if (pending_[body]) return;
  pending_[body] = 1;
  changed_.push_back(body);
}

void Events::removed(BodyId body) {
  take_away(body);
  pending_[body] = 0;
  windows_[body] = {kNeverStep, kNeverStep};  // voids the events and the next look, until the slot's next body
}

void Events::take_away(BodyId body) noexcept {
  if (places_[body] == Place::grid) grid_.remove(body, boxes_[body]);
  if (places_[body] == Place::oversized) std::erase(oversized_, body);
  places_[body] = Place::nowhere;
}

// In the order of the calendar bodies are all over memory: what is needed next is loaded ahead.
void Events::take_away_due() noexcept {
  constexpr std::size_t kBoxAhead = 24, kLineAhead = 12;
  for (std::size_t i = 0; i < due_.size(); ++i) {
    if (i + kBoxAhead < due_.size()) prefetch(&boxes_[due_[i + kBoxAhead]]);
    if (i + kLineAhead < due_.size()) grid_.prepare_removal(boxes_[due_[i + kLineAhead]]);
    take_away(due_[i]);
  }
}

void Events::collect_due(Step now) {
  constexpr std::size_t kAhead = 16;
  entries_.clear();
  events_.clear();
  due_.clear();
  calendar_.take(now, entries_, events_);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (i + kAhead < entries_.size()) prefetch(&windows_[entries_[i + kAhead]]);
    Window& window = windows_[entries_[i]];
    if (window.end != now || pending_[entries_[i]]) continue;  // looked at since
    window.end = kLookDue;
    due_.push_back(entries_[i]);
  }
  for (const BodyId body : changed_) {
    if (!pending_[body]) continue;
    pending_[body] = 0;
    due_.push_back(body);
  }
  changed_.clear();
  if (changed_.capacity() > kChangesKept) changed_.shrink_to_fit();  // not what adding all bodies took
}

void Events::place_all_anew() {
  calendar_.clear_bodies();
  std::fill(places_.begin(), places_.end(), Place::nowhere);
  oversized_.clear();
  if (due_.capacity() > 2 * roster_.size()) due_ = {};
  due_.clear();
  due_.reserve(roster_.size());
  for (BodyId body = 0; body < roster_.slots(); ++body) {
    if (roster_.alive(body)) due_.push_back(body);
  }
  grid_.reset(plan_.lines);
}

// Steps until the next look: until the bound expires, in equal parts that are not longer than the plan's window.
Step Events::window_of(Step now, const Motion& motion) noexcept {
  if (now == last_now_ && motion.expiry == last_expiry_) return last_window_;
  const Step valid = roster_.clock.steps_until_expiry(now, motion.expiry);
  Step window = plan_.window;
  if (valid < 64 * plan_.window) {
    const Step parts = (valid + plan_.window) / plan_.window;
    window = (valid + parts) / parts;
  }
  last_now_ = now;
  last_expiry_ = motion.expiry;
  return last_window_ = window;
}

// Makes the boxes of a block of bodies, until the ends of their windows.
void Events::place(Step now, std::span<const BodyId> bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool moves = !roster_.is_static(bodies[i]);
    const Step steps = moves ? window_of(now, motions_[i]) : 1;
    motion_block_.set(i, motions_[i], static_cast<double>(steps - 1) * options_.time_step);
    windows_[bodies[i]] = {now, moves ? now + steps : kNeverStep};
  }
  for (std::size_t i = 0; i < bodies.size(); i += kMeansStride) means_.add(motions_[i]);
  lattice_.boxes(motion_block_, bodies.size(), box_block_, options_.vectors);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyId body = bodies[i];
    const QuantumBox& box = boxes_[body] = box_block_.get(i);
    places_[body] = cells_fit(box) ? Place::grid : Place::oversized;
    if (places_[body] == Place::oversized) shrink(now, body, i);
    if (windows_[body].end != kNeverStep) calendar_.set_due(body, windows_[body].end);
  }
}

// Faster than the others: look at it again sooner, until its box takes few enough cells.
void Events::shrink(Step now, BodyId body, std::size_t i) {
  Step steps = windows_[body].end == kNeverStep ? 1 : windows_[body].end - now;
  MotionBlock one;
  BoxBlock box;
  while (steps > 1) {
    steps = (steps + 1) / 2;
    one.set(0, motions_[i], static_cast<double>(steps - 1) * options_.time_step);
    lattice_.boxes(one, 1, box, options_.vectors);
    boxes_[body] = box.get(0);
    windows_[body].end = now + steps;
    if (!cells_fit(boxes_[body])) continue;
    places_[body] = Place::grid;
    break;
  }
  box_block_.set(i, boxes_[body]);
}

// Stops early if the budget is spent; returns how many have been looked at.
std::size_t Events::look_at(Step now, std::span<const BodyId> bodies, Meter& meter) {
  motions_.resize(kBlock);
  std::size_t done = 0;
  while (done < bodies.size() && !meter.spent()) {
    const auto block = bodies.subspan(done, meter.grant(std::min(kBlock, bodies.size() - done)));
    roster_.ask(now, block, std::span(motions_).first(block.size()));
    meter.count(block.size());
    place(now, block);
    insert(block);
    done += block.size();
  }
  return done;
}

void Events::insert(std::span<const BodyId> bodies) {
  const auto oversized = [&](BodyId body) { return places_[body] == Place::oversized; };
  if (oversized_.empty() && std::none_of(bodies.begin(), bodies.end(), oversized)) {
    grid_.insert(bodies, box_block_, boxes_, options_.vectors, near_);
    return;
  }
  std::array<BodyId, kBlock> in_grid;
  std::size_t count = 0;
  for (const BodyId body : bodies) {
    if (oversized(body)) continue;
    box_block_.set(count, boxes_[body]);
    in_grid[count++] = body;
  }
  grid_.insert(std::span(in_grid).first(count), box_block_, boxes_, options_.vectors, near_);
  meet_oversized(bodies);
}

// Bodies as large as several cells are compared with everything: (their number) x (the number of all) per window.
void Events::meet_oversized(std::span<const BodyId> bodies) {
  const auto compare = [&](BodyId body, BodyId other) {
    if (boxes_[other].meets(boxes_[body])) near_.push_back({std::min(body, other), std::max(body, other)});
  };
  for (const BodyId body : bodies) {
    if (places_[body] != Place::grid) continue;
    for (const BodyId large : oversized_) compare(body, large);
  }
  for (const BodyId body : bodies) {
    if (places_[body] != Place::oversized) continue;
    for (BodyId other = 0; other < places_.size(); ++other) {
      if (places_[other] == Place::grid) compare(body, other);
    }
    for (const BodyId large : oversized_) compare(body, large);
    oversized_.push_back(body);
  }
}

bool Events::valid(const PairEvent& event) const noexcept {
  return windows_[event.pair.a].looked <= event.created && windows_[event.pair.b].looked <= event.created;
}

// Stops early if the budget is spent; the rest is tested at the next step.
bool Events::test_all(Step now, Meter& meter) {
  constexpr std::size_t kPairs = kBlock / 2;
  motions_.resize(kBlock);
  std::array<BodyId, kBlock> bodies;
  std::size_t done = 0;
  while (done < tests_.size() && !meter.spent()) {
    const std::size_t count = std::max<std::size_t>(1, meter.grant(2 * std::min(kPairs, tests_.size() - done)) / 2);
    for (std::size_t i = 0; i < count; ++i) {
      bodies[2 * i] = tests_[done + i].pair.a;
      bodies[2 * i + 1] = tests_[done + i].pair.b;
    }
    roster_.ask(now, std::span(bodies).first(2 * count), std::span(motions_).first(2 * count));
    meter.count(2 * count);
    for (std::size_t i = 0; i < count; ++i) settle(now, tests_[done + i].pair, motions_[2 * i], motions_[2 * i + 1]);
    done += count;
  }
  for (std::size_t i = done; i < tests_.size(); ++i) calendar_.add(tests_[i], now + 1);
  return done == tests_.size();
}

// Both motions are of this step: they overlap, surely for a while, or they cannot for a while.
void Events::settle(Step now, const BodyPair& pair, const Motion& a, const Motion& b) {
  if (roster_.is_static(pair.a) && roster_.is_static(pair.b)) return;
  const Clock& clock = roster_.clock;
  // Until the next look at one of them, or a bound expires.
  const Step safe = std::min(clock.steps_until_expiry(now, a.expiry), clock.steps_until_expiry(now, b.expiry));
  const Step left = std::min({windows_[pair.a].end, windows_[pair.b].end, now + kLongestWindow}) - now;
  const double seconds = static_cast<double>(std::max<Step>(0, std::min(left - 1, safe))) * options_.time_step;
  if (spheres_touch(a, b)) {
    overlaps_.push_back({pair, now, now + clock.steps_within(overlap_lasts(a, b, seconds))});
    return;
  }
  if (left <= 1) return;
  const double contact = earliest_contact(a, b, seconds, kEventResolution * options_.time_step);
  Step ahead = contact <= seconds ? std::max<Step>(1, clock.steps_before(contact)) : kNeverStep;
  if (safe < left) ahead = std::min(ahead, safe + 1);
  if (ahead < left) calendar_.add({pair, now}, now + ahead);
}

// What an interruption left over is done at the next step.
void Events::postpone(Step now, std::size_t looked, unsigned from_class) {
  for (; looked < due_.size(); ++looked) {
    windows_[due_[looked]].end = now + 1;
    calendar_.set_due(due_[looked], now + 1);
  }
  for (const PairEvent& event : waiting_) {
    if (roster_.importance(event.pair) >= from_class) calendar_.add(event, now + 1);
  }
  for (const BodyPair& pair : near_) {
    if (roster_.importance(pair) >= from_class) calendar_.add({pair, now}, now + 1);
  }
}

// Class by class: first its bodies, then the pairs with such a body and none that is less important. Returns the class
// that an interruption left unfinished.
unsigned Events::look_and_test(Step now, Meter& meter) {
  const bool one_class = roster_.one_class();
  if (!one_class) {
    std::stable_sort(due_.begin(), due_.end(),
                     [&](BodyId a, BodyId b) { return roster_.importance(a) < roster_.importance(b); });
  }
  std::size_t looked = 0;
  for (unsigned rank = roster_.next_class(0); rank < kNoClass;
       rank = one_class ? kNoClass : roster_.next_class(rank + 1)) {
    std::size_t end = one_class ? due_.size() : looked;
    while (end < due_.size() && roster_.importance(due_[end]) == rank) ++end;
    looked += look_at(now, std::span(due_).subspan(looked, end - looked), meter);
    if (looked < end) {
      postpone(now, looked, rank);
      return rank;
    }
    const auto ranked = [&](const BodyPair& pair) { return one_class || roster_.importance(pair) == rank; };
    tests_.clear();
    for (const PairEvent& event : waiting_) {
      if (ranked(event.pair) && valid(event)) (event.sure >= now ? overlaps_ : tests_).push_back(event);
    }
    for (const BodyPair& pair : near_) {
      if (ranked(pair)) tests_.push_back({pair, now});
    }
    if (!test_all(now, meter)) {
      postpone(now, looked, rank + 1);
      return rank;
    }
  }
  return kNoClass;
}

StepReport Events::step(Step now, Meter& meter, std::vector<BodyPair>& pairs) {
  collect_due(now);
  if (worth_a_rebuild()) {
    replan(now);
    place_all_anew();
  } else {
    take_away_due();
  }
  near_.clear();
  waiting_.assign(overlaps_.begin(), overlaps_.end());
  waiting_.insert(waiting_.end(), events_.begin(), events_.end());
  overlaps_.clear();
  const unsigned incomplete_from = look_and_test(now, meter);

  std::sort(overlaps_.begin(), overlaps_.end(), [](const PairEvent& a, const PairEvent& b) { return a.pair < b.pair; });
  for (const PairEvent& event : overlaps_) pairs.push_back(event.pair);
  return {overlaps_.empty() ? calendar_.next_after(now) : now + 1, incomplete_from};
}

std::size_t Events::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(boxes_) + bytes_of(windows_) + bytes_of(places_) + bytes_of(pending_) +
         bytes_of(changed_) + bytes_of(entries_) + bytes_of(oversized_) + bytes_of(overlaps_) + bytes_of(due_) +
         bytes_of(events_) + bytes_of(waiting_) + bytes_of(tests_) + bytes_of(near_) + bytes_of(motions_) +
         grid_.memory_bytes() + calendar_.memory_bytes() - sizeof(calendar_);
}

std::unique_ptr<Method> make_events(Roster& roster, const BroadPhaseOptions& options) {
  return std::make_unique<Events>(roster, options);
}

}  // namespace orchard::runtime::detail
