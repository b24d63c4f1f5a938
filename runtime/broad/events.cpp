#include "events.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kManyPairs = 0.5;     // per body: so many are worth a note of each body's sphere
constexpr std::uint8_t kPatience = 2;  // bounds that last for a step at most, one after the other, that mean nothing
constexpr std::size_t kChangesKept = 1024;  // room for as many changes in a step stays allocated

}  // namespace

void Events::make_room() {
  const std::size_t n = pool_.slots();
  if (windows_.size() >= n) return;
  grow(places_, n);
  grow(pending_, n);
  overlaps_.make_room(n);
  grow(windows_, n);  // last: it tells that there is room in all of them
}

void Events::changed(BodyIndex body) {
  make_room();
  if (pending_[body]) return;
  changed_.push_back(body);
  pending_[body] = 1;
}

void Events::removed(BodyIndex body) noexcept {
  if (windows_[body].length > 0) ++cancellations_;
  take_away(body);
  backlog_.leave(body);
  pending_[body] = 0;
  windows_[body] = {.end = kNeverStep};  // no next update, until the slot's next body
  void_events(body);
}

void Events::void_events(BodyIndex body) noexcept {
  windows_[body].updated = round_ + 1;
  windows_[body].length = 0;
  overlaps_.mark(body, OverlapList::kUpdated);
}

// Its bounds have ended before their time. Now and then that says nothing of the next ones, which may hold for as long
// as any. Only where bounds last for no more than a step again and again a long window is of no use.
void Events::note_cancelled(Window& window, Step now) noexcept {
  if (window.length == 0 || window.end < 0 || window.end == kNeverStep) return;
  ++cancellations_;
  const Step lasted = now - (window.end - window.length);
  if (lasted < 0) return;
  if (lasted > 1) return window.rely_longer();
  window.lasting = window.lasting > kLastsAsEver - kPatience ? window.lasting - 1 : 1;
  any_short_ = any_short_ || window.lasting == 1;
}

void Events::take_away(BodyIndex body) noexcept {
  if (places_[body] == Place::inside) few_ ? list_.remove(body) : grid_.remove(body, boxes_[body]);
  if (places_[body] == Place::oversized) std::erase(oversized_, body);
  places_[body] = Place::nowhere;
}

// In the order of the timing wheel bodies are all over memory: what is needed next is loaded ahead.
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
    if (window.end != now || pending_[entries_[i]]) continue;  // updated since
    window.end = kUpdateDue;
    window.rely_longer();
    due_.push_back(entries_[i]);
  }
  for (const BodyIndex body : changed_) {
    if (!pending_[body]) continue;
    pending_[body] = 0;
    note_cancelled(windows_[body], now);
    due_.push_back(body);
  }
  changed_.clear();
  if (changed_.capacity() > kChangesKept) changed_.shrink_to_fit();  // not what adding all bodies took
}

// What has not been updated for this step yet is in due_ already; the rest changed since, or was added.
void Events::complete_due(Step now) {
  std::erase_if(due_, [&](BodyIndex body) { return !pool_.alive(body) || pending_[body]; });
  for (const BodyIndex body : changed_) {
    if (!pending_[body]) continue;
    take_away(body);
    pending_[body] = 0;
    note_cancelled(windows_[body], now);
    due_.push_back(body);
  }
  changed_.clear();
}

void Events::make_room_for_spheres() {
  if (plan_.window == 1 || plan_.pairs_per_body >= kManyPairs) {
    grow(spheres_, pool_.slots());
  } else {
    give_back(spheres_);
  }
}

void Events::make_room_for_boxes() {
  if (few_) {
    list_.grow(pool_.slots());
  } else {
    grow(boxes_, pool_.slots());
  }
  if (!spheres_.empty()) make_room_for_spheres();
}

// Everything that is due, and what a budget left over before.
void Events::step_in_full(Step now, bool completing) {
  if (!backlog_.empty()) {
    for (const BodyIndex body : due_) backlog_.leave(body);  // changed while it waited: one update is enough
    backlog_.take_all(due_, waiting_);
  }
  bool all_anew = completing;
  BudgetTracker unlimited;
  if (!completing) {
    all_anew = sorting_ || outgrown() || worth_a_rebuild(due_.size());
    if (all_anew) {
      replan(now, unlimited);
      if (worth_sorting(now)) return step_by_sorting(now);
      place_all_anew();
      wheel_.clear_events();  // updates of all windows void them
    } else {
      make_room_for_boxes();
      take_away_due();
    }
  }
  make_room_for_boxes();
  if (all_anew) {
    overlaps_.begin_anew();
    make_room_for_spheres();
  }
  update_windows(now, now, due_, Found::tested);
  test_due(now);
  if (!all_anew) return;
  const bool lasts = plan_.window >= kMinStepsBeforeCommonExpiry;
  common_expiry_ = lasts && pool_.size() >= kMinBodiesAtCommonExpiry && 4 * votes_ > pool_.size() ? voted_ : kNeverStep;
}

// What the updates have left of it.
void Events::test_due(Step now) {
  std::erase_if(waiting_, [&](const PairEvent& event) { return !valid(event); });
  test(now, waiting_);
  for (const PairEvent& event : overlaps_ahead_) {
    if (valid(event)) overlaps_.add(event.pair);
  }
  overlaps_ahead_.clear();
}

// Nothing is left to plan for, nor to wake up for.
void Events::forget_all() noexcept {
  wheel_.clear();
  overlaps_.clear();
  overlaps_ahead_.clear();
  doubtful_.clear();
  changed_.clear();
  due_.clear();
  surveyed_.clear();
  prepared_ = false;
  common_expiry_ = kNeverStep;
}

StepReport Events::step(Step now, BudgetTracker& tracker) {
  if (pool_.size() == 0) {
    forget_all();
    return {kNeverStep, {}};
  }
  ++round_;
  entries_.clear();
  waiting_.clear();
  wheel_.take(now, entries_, waiting_);
  const bool completing = prepared_ && !outgrown();
  limited_ = tracker.limited();
  for (const PairEvent& event : doubtful_) overlaps_.drop(event.pair);
  doubtful_.clear();
  if (prepared_) {
    complete_due(now);
  } else {
    due_.clear();
    sorting_ ? collect_all(now) : collect_due(now);
  }
  prepared_ = false;
  near_.clear();
  unsigned incomplete_from = kNoClass;
  if (limited_) {
    waiting_.insert(waiting_.end(), overlaps_ahead_.begin(), overlaps_ahead_.end());
    overlaps_ahead_.clear();
    incomplete_from = step_within(now, tracker);
    if (incomplete_from != kNoClass) interrupted_at_ = now;
    keep_doubtful();
  } else {
    step_in_full(now, completing);
  }
  overlaps_.update(pool_.slots());
  StepReport report{now + 1, overlaps_.pairs()};
  if (incomplete_from != kNoClass) {
    report.incomplete_from = incomplete_from;
    report.left_over = std::max<std::size_t>(1, backlog_.size());
    return report;
  }
  if (now + 1 == common_expiry_ && !limited_ && prepare(now)) return report;
  if (!changed_.empty() || !report.pairs.empty()) return report;
  if (sorting_) return report;
  report.next = wheel_.next_after(now);
  if (common_expiry_ != kNeverStep && common_expiry_ - 1 > now) report.next = std::min(report.next, common_expiry_ - 1);
  return report;
}

std::size_t Events::foresee(Step now, std::span<StepsAhead> steps) const noexcept {
  const std::size_t known = std::min<std::size_t>(steps.size(), kWheelSteps - 2);
  if (sorting_ && known > 0) steps[0].updates += pool_.size();
  for (std::size_t i = 0; i < known; ++i) {
    const Step step = now + 1 + static_cast<Step>(i);
    steps[i].updates += wheel_.bodies_due(step);
    steps[i].meetings += wheel_.events_due(step);
    steps[i].overlaps += overlaps_.pairs().size();
  }
  return known;
}

std::size_t Events::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(boxes_) + bytes_of(windows_) + bytes_of(places_) + bytes_of(pending_) +
         bytes_of(changed_) + bytes_of(entries_) + bytes_of(oversized_) + overlaps_.memory_bytes() +
         bytes_of(overlaps_ahead_) + bytes_of(doubtful_) + bytes_of(due_) + bytes_of(spheres_) + bytes_of(waiting_) +
         bytes_of(tests_) + bytes_of(near_) + bytes_of(motions_) + bytes_of(surveyed_) + backlog_.memory_bytes() +
         list_.memory_bytes() + grid_.memory_bytes() + sorted_.memory_bytes() + wheel_.memory_bytes() - sizeof(wheel_);
}

std::unique_ptr<Method> make_events(BodyPool& pool, const BroadPhaseOptions& options) {
  return std::make_unique<Events>(pool, options);
}

}  // namespace orchard::runtime::detail
