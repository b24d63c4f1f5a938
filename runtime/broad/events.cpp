#include "events.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kChangesKept = 1024;  // room for as many changes in a step stays allocated
constexpr Step kLookDue = -1;               // a window's end while its body waits for a look

}  // namespace

void Events::make_room() {
  const std::size_t n = roster_.slots();
  if (windows_.size() >= n) return;
  grow(windows_, n);
  grow(places_, n);
  grow(pending_, n);
}

void Events::changed(BodyIndex body) {
  make_room();
  if (pending_[body]) return;
  pending_[body] = 1;
  changed_.push_back(body);
}

void Events::removed(BodyIndex body) {
  take_away(body);
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

// What an interruption left over is done at the next step.
void Events::postpone(Step now, std::size_t looked, unsigned from_class) {
  for (; looked < due_.size(); ++looked) {
    windows_[due_[looked]].end = now + 1;
    calendar_.set_due(std::span(due_).subspan(looked, 1), now + 1);
  }
  for (const PairEvent& event : waiting_) {
    if (roster_.importance(event.pair) >= from_class) calendar_.add(event, now + 1);
  }
  for (const BodyPair& pair : near_) {
    if (roster_.importance(pair) >= from_class) calendar_.add({pair, round_}, now + 1);
  }
}

// Class by class: first its bodies, then the pairs with such a body and none that is less important. Returns the class
// that an interruption left unfinished.
unsigned Events::look_and_test(Step now, Meter& meter) {
  const bool one_class = roster_.one_class();
  if (!one_class) {
    std::stable_sort(due_.begin(), due_.end(),
                     [&](BodyIndex a, BodyIndex b) { return roster_.importance(a) < roster_.importance(b); });
  }
  std::size_t looked = 0;
  for (unsigned rank = roster_.next_class(0); rank < kNoClass;
       rank = one_class ? kNoClass : roster_.next_class(rank + 1)) {
    std::size_t end = one_class ? due_.size() : looked;
    while (end < due_.size() && roster_.importance(due_[end]) == rank) ++end;
    looked += look_at(now, now, std::span(due_).subspan(looked, end - looked), meter);
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
      if (ranked(pair)) tests_.push_back({pair, round_});
    }
    if (!test_all(now, meter)) {
      postpone(now, looked, rank + 1);
      return rank;
    }
  }
  return kNoClass;
}

// Nothing is left to plan for, nor to wake up for.
void Events::forget_all() noexcept {
  calendar_.clear();
  overlaps_.clear();
  changed_.clear();
  due_.clear();
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
  const bool outgrown = few_ && roster_.slots() > list_.slots();
  const bool completing = prepared_round_ >= 0 && !outgrown;
  bool all_anew = completing;
  if (completing) {
    complete_due();
  } else {
    due_.clear();
    collect_due(now);
    all_anew = outgrown || worth_a_rebuild();
    if (all_anew) {
      replan(now);
      place_all_anew();
    } else {
      take_away_due();
    }
  }
  prepared_round_ = -1;
  if (!few_) grow(boxes_, roster_.slots());
  near_.clear();
  waiting_.assign(overlaps_.begin(), overlaps_.end());
  waiting_.insert(waiting_.end(), events_.begin(), events_.end());
  overlaps_.clear();
  const unsigned incomplete_from = look_and_test(now, meter);

  std::sort(overlaps_.begin(), overlaps_.end(), [](const PairEvent& a, const PairEvent& b) { return a.pair < b.pair; });
  for (const PairEvent& event : overlaps_) pairs.push_back(event.pair);

  if (all_anew) rush_ = roster_.size() >= kFewestInRush && 4 * votes_ > roster_.size() ? voted_ : kNeverStep;
  if (now + 1 == rush_ && !all_anew && incomplete_from == kNoClass && !meter.limited() && prepare(now)) return {rush_};
  Step next = overlaps_.empty() ? calendar_.next_after(now) : now + 1;
  if (rush_ != kNeverStep && rush_ - 1 > now) next = std::min(next, rush_ - 1);
  return {next, incomplete_from};
}

std::size_t Events::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(boxes_) + bytes_of(windows_) + bytes_of(places_) + bytes_of(pending_) +
         bytes_of(changed_) + bytes_of(entries_) + bytes_of(oversized_) + bytes_of(overlaps_) + bytes_of(due_) +
         bytes_of(events_) + bytes_of(waiting_) + bytes_of(tests_) + bytes_of(near_) + bytes_of(motions_) +
         list_.memory_bytes() + grid_.memory_bytes() + calendar_.memory_bytes() - sizeof(calendar_);
}

std::unique_ptr<Method> make_events(Roster& roster, const BroadPhaseOptions& options) {
  return std::make_unique<Events>(roster, options);
}

}  // namespace orchard::runtime::detail
