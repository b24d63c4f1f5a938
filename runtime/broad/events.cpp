#include "events.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kChangesKept = 1024;  // room for as many changes in a step stays allocated

}  // namespace

void Events::make_room() {
  const std::size_t n = roster_.slots();
  if (windows_.size() >= n) return;
  grow(places_, n);
  grow(pending_, n);
  grow(windows_, n);  // last: it tells that there is room in all of them
}

void Events::changed(BodyIndex body) {
  make_room();
  if (pending_[body]) return;
  changed_.push_back(body);
  pending_[body] = 1;
}

void Events::removed(BodyIndex body) noexcept {
  take_away(body);
  backlog_.leave(body);
  pending_[body] = 0;
  windows_[body] = {kNeverStep, kNeverStep};  // voids the events and the next look, until the slot's next body
}

void Events::take_away(BodyIndex body) noexcept {
  if (places_[body] == Place::inside) few_ ? list_.remove(body) : grid_.remove(body, boxes_[body]);
  if (places_[body] == Place::oversized) std::erase(oversized_, body);
  places_[body] = Place::nowhere;
}

// In the order of the calendar bodies are all over memory: what is needed next is loaded ahead.
void Events::take_away_due() noexcept {
  constexpr std::size_t kBoxAhead = 24, kLineAhead = 12;
  const std::size_t lines = few_ ? 0 : due_.size();
  for (std::size_t i = 0; i < due_.size(); ++i) {
    if (i + kBoxAhead < lines) prefetch(&boxes_[due_[i + kBoxAhead]]);
    if (i + kLineAhead < lines && places_[due_[i + kLineAhead]] == Place::inside) {
      grid_.prepare_removal(boxes_[due_[i + kLineAhead]]);
    }
    take_away(due_[i]);
  }
}

void Events::collect_due(Step now) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (i + kAhead < entries_.size()) {
      const BodyIndex body = entries_[i + kAhead];
      prefetch(&windows_[body]), prefetch(&places_[body]), prefetch(&pending_[body]);
    }
    Window& window = windows_[entries_[i]];
    if (window.end != now || pending_[entries_[i]]) continue;  // looked at since
    window.end = kLookDue;
    due_.push_back(entries_[i]);
  }
  for (const BodyIndex body : changed_) {
    if (!pending_[body]) continue;
    pending_[body] = 0;
    due_.push_back(body);
  }
  changed_.clear();
  if (changed_.capacity() > kChangesKept) changed_.shrink_to_fit();  // not what adding all bodies took
}

// What has not been looked at for this step yet is in due_ already; the rest changed since, or was added.
void Events::complete_due() {
  std::erase_if(due_, [&](BodyIndex body) { return !roster_.alive(body) || pending_[body]; });
  for (const BodyIndex body : changed_) {
    if (!pending_[body]) continue;
    take_away(body);
    pending_[body] = 0;
    due_.push_back(body);
  }
  changed_.clear();
}

void Events::make_room_for_boxes() {
  if (few_) {
    list_.grow(roster_.slots());
  } else {
    grow(boxes_, roster_.slots());
  }
}

// Everything that is due, and what a budget left over before.
void Events::step_in_full(Step now, bool completing) {
  if (!backlog_.empty()) {
    for (const BodyIndex body : due_) backlog_.leave(body);  // changed while it waited: one look is enough
    backlog_.take_all(due_, waiting_);
  }
  bool all_anew = completing;
  Meter unlimited;
  if (!completing) {
    all_anew = outgrown() || worth_a_rebuild(due_.size());
    if (all_anew) {
      replan(now, unlimited);
      place_all_anew();
    } else {
      make_room_for_boxes();
      take_away_due();
    }
  }
  make_room_for_boxes();
  look_at(now, now, due_);
  tests_.clear();
  for (const PairEvent& event : waiting_) {
    if (valid(event)) (event.sure >= now ? overlaps_ : tests_).push_back(event);
  }
  for (const BodyPair& pair : near_) tests_.push_back({pair, round_});
  test(now, tests_);
  if (all_anew) rush_ = roster_.size() >= kFewestInRush && 4 * votes_ > roster_.size() ? voted_ : kNeverStep;
}

// Nothing is left to plan for, nor to wake up for.
void Events::forget_all() noexcept {
  calendar_.clear();
  overlaps_.clear();
  changed_.clear();
  due_.clear();
  surveyed_.clear();
  prepared_round_ = -1;
  rush_ = kNeverStep;
}

StepReport Events::step(Step now, Meter& meter, std::vector<BodyPair>& pairs) {
  if (roster_.size() == 0) {
    forget_all();
    return {kNeverStep};
  }
  ++round_;
  entries_.clear();
  events_.clear();
  calendar_.take(now, entries_, events_);
  const bool completing = prepared_round_ >= 0 && !outgrown(), limited = meter.limited();
  if (completing) {
    complete_due();
  } else {
    due_.clear();
    collect_due(now);
  }
  prepared_round_ = -1;
  near_.clear();
  waiting_.assign(overlaps_.begin(), overlaps_.end());
  waiting_.insert(waiting_.end(), events_.begin(), events_.end());
  overlaps_.clear();
  unsigned incomplete_from = kNoClass;
  if (limited) {
    incomplete_from = step_within(now, meter);
    if (incomplete_from != kNoClass) interrupted_at_ = now;
  } else {
    step_in_full(now, completing);
  }
  report(pairs);
  if (incomplete_from != kNoClass) return {now + 1, incomplete_from, std::max<std::size_t>(1, backlog_.size())};

  if (now + 1 == rush_ && !limited && prepare(now)) return {rush_};
  if (!changed_.empty()) return {now + 1};
  Step next = overlaps_.empty() ? calendar_.next_after(now) : now + 1;
  if (rush_ != kNeverStep && rush_ - 1 > now) next = std::min(next, rush_ - 1);
  return {next};
}

// Within a budget a pair can come up twice: when it was due, and when a look found it.
void Events::report(std::vector<BodyPair>& pairs) {
  std::sort(overlaps_.begin(), overlaps_.end(), [](const PairEvent& a, const PairEvent& b) {
    return a.pair != b.pair ? a.pair < b.pair : a.created > b.created;
  });
  const auto same = [](const PairEvent& a, const PairEvent& b) { return a.pair == b.pair; };
  overlaps_.erase(std::unique(overlaps_.begin(), overlaps_.end(), same), overlaps_.end());
  for (const PairEvent& event : overlaps_) pairs.push_back(event.pair);
}

std::size_t Events::foresee(Step now, std::span<StepsAhead> steps) const noexcept {
  const std::size_t known = std::min<std::size_t>(steps.size(), kCalendarSteps - 2);
  for (std::size_t i = 0; i < known; ++i) {
    const Step step = now + 1 + static_cast<Step>(i);
    steps[i].looks += calendar_.bodies_due(step);
    steps[i].meetings += calendar_.events_due(step);
    steps[i].overlaps += overlaps_.size();
  }
  return known;
}

std::size_t Events::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(boxes_) + bytes_of(windows_) + bytes_of(places_) + bytes_of(pending_) +
         bytes_of(changed_) + bytes_of(entries_) + bytes_of(oversized_) + bytes_of(overlaps_) + bytes_of(due_) +
         bytes_of(events_) + bytes_of(waiting_) + bytes_of(tests_) + bytes_of(near_) + bytes_of(motions_) +
         bytes_of(surveyed_) + backlog_.memory_bytes() + list_.memory_bytes() + grid_.memory_bytes() +
         calendar_.memory_bytes() - sizeof(calendar_);
}

std::unique_ptr<Method> make_events(Roster& roster, const BroadPhaseOptions& options) {
  return std::make_unique<Events>(roster, options);
}

}  // namespace orchard::runtime::detail
