#include <algorithm>

#include "method.h"
#include "orchard/runtime/space_time_bound.h"

namespace orchard::runtime::detail {
namespace {

constexpr Step kLongestSleep = 1000;  // steps: a common end is needed even if no bound expires

// The dissertation's broad phase (Fig. 4.23): sleep until the earliest two bounds touch, rebuild, and look again. While
// bounds touch it goes on step by step, and reports the pairs whose spheres really overlap. Interrupted, it leaves out
// the classes whose motions it could not ask for: what is limited is the asking, not the search that follows.
class Sleeping final : public Method {
 public:
  Sleeping(Roster& roster, const BroadPhaseOptions& options)
      : roster_(roster), rebuild_all_(options.rebuild == Rebuild::everything), find_(find_options(options.method)) {}

  void changed(BodyIndex body) override;
  void removed(BodyIndex) override { members_changed_ = true; }
  void reclassified(BodyIndex) override {}
  StepReport step(Step now, Meter& meter, std::vector<BodyPair>& pairs) override;
  std::size_t memory_bytes() const noexcept override;

 private:
  struct Known {
    Motion motion;
    Step asked = -1;  // the step that the motion is of; -1: to be asked for
    Step end = 0;     // the first step at which it does not hold
  };

  static IntersectionOptions find_options(BroadPhaseMethod method);
  void refresh_members();
  unsigned ask_for_stale(Step now, Meter& meter);
  Step build(Step now, unsigned below);
  bool intersecting_are_current(Step now, const Intersections& found);

  Roster& roster_;
  const bool rebuild_all_;
  const IntersectionOptions find_;
  IntersectionFinder finder_;
  std::vector<Known> known_;  // by body
  std::vector<BodyIndex> members_, stale_;
  std::vector<Motion> motions_;
  std::vector<BodyIndex> present_;      // the members whose class takes part in this step
  std::vector<SpaceTimeBound> bounds_;  // by place in present_
  bool members_changed_ = true;
};

IntersectionOptions Sleeping::find_options(BroadPhaseMethod method) {
  switch (method) {
    case BroadPhaseMethod::projection:
      return {.method = IntersectionMethod::projection};
    case BroadPhaseMethod::subdivision:
      return {.method = IntersectionMethod::subdivision};
    case BroadPhaseMethod::hybrid:
      return {.method = IntersectionMethod::hybrid};
    case BroadPhaseMethod::quadratic:
      return {.method = IntersectionMethod::projection, .shape = BoundShape::quadratic};
    case BroadPhaseMethod::horns:
      return {.method = IntersectionMethod::sorted, .shape = BoundShape::horn};
    default:
      return {.method = IntersectionMethod::all_pairs};
  }
}

void Sleeping::changed(BodyIndex body) {
  if (known_.size() < roster_.slots()) known_.resize(roster_.slots());
  known_[body].asked = -1;
  members_changed_ = true;
}

void Sleeping::refresh_members() {
  if (!members_changed_) return;
  members_changed_ = false;
  members_.clear();
  for (BodyIndex body = 0; body < roster_.slots(); ++body) {
    if (roster_.alive(body)) members_.push_back(body);
  }
}

// The more important first. Returns the class from which on some could not be asked for.
unsigned Sleeping::ask_for_stale(Step now, Meter& meter) {
  stale_.clear();
  for (const BodyIndex body : members_) {
    if (known_[body].asked < 0 || known_[body].end <= now) stale_.push_back(body);
  }
  if (!roster_.one_class()) {
    std::stable_sort(stale_.begin(), stale_.end(),
                     [&](BodyIndex a, BodyIndex b) { return roster_.importance(a) < roster_.importance(b); });
  }
  motions_.resize(stale_.size());
  std::size_t done = 0;
  while (done < stale_.size() && !meter.spent()) {
    const std::size_t count = meter.grant(stale_.size() - done);
    roster_.ask(now, std::span(stale_).subspan(done, count), std::span(motions_).subspan(done, count));
    meter.count(count);
    done += count;
  }
  for (std::size_t i = 0; i < done; ++i) {
    const Step last = roster_.clock.last_before_expiry(motions_[i].expiry);
    const bool for_ever = last == kNeverStep || roster_.is_static(stale_[i]);
    known_[stale_[i]] = {motions_[i], now, for_ever ? kNeverStep : std::max(now, last) + 1};
  }
  return done < stale_.size() ? roster_.importance(stale_[done]) : kNoClass;
}

// The bounds of all classes below one, over the same interval, from now until the first one expires; returns the first
// step after it.
Step Sleeping::build(Step now, unsigned below) {
  present_.clear();
  for (const BodyIndex body : members_) {
    if (roster_.importance(body) < below) present_.push_back(body);
  }
  Step end = now + kLongestSleep;
  for (const BodyIndex body : present_) end = std::min(end, known_[body].end);
  const double duration = static_cast<double>(end - 1 - now) * roster_.clock.time_step;
  bounds_.clear();
  for (const BodyIndex body : present_) {
    const double age = static_cast<double>(now - known_[body].asked) * roster_.clock.time_step;
    bounds_.push_back(make_bound(known_[body].motion, age, duration));
    bounds_.back().fixed = roster_.is_static(body);
  }
  return end;
}

// Those that touch now have to be of now before anything can be said of the spheres.
bool Sleeping::intersecting_are_current(Step now, const Intersections& found) {
  bool current = true;
  for (const BoundContact& contact : found.initial) {
    if (contact.time > 0) continue;
    for (const BodyIndex body : {present_[contact.a], present_[contact.b]}) {
      if (known_[body].asked == now || roster_.is_static(body)) continue;
      known_[body].asked = -1;
      current = false;
    }
  }
  return current;
}

StepReport Sleeping::step(Step now, Meter& meter, std::vector<BodyPair>& pairs) {
  refresh_members();
  if (members_.empty()) return {kNeverStep};
  if (rebuild_all_) {
    for (const BodyIndex body : members_) known_[body].asked = -1;
  }
  unsigned below = kNoClass;
  for (;;) {
    below = std::min(below, ask_for_stale(now, meter));
    const Step end = build(now, below);
    const double duration = static_cast<double>(end - 1 - now) * roster_.clock.time_step;
    const Intersections& found = finder_.find(bounds_, duration, find_);
    if (!intersecting_are_current(now, found)) continue;

    for (const BoundContact& contact : found.initial) {
      const BodyIndex a = present_[contact.a], b = present_[contact.b];
      if (contact.time <= 0 && spheres_touch(known_[a].motion, known_[b].motion)) pairs.push_back({a, b});
    }
    if (below < kNoClass) return {now + 1, below};
    const BoundContact& first = found.earliest;
    if (first.time == kNoContact) return {end};
    known_[present_[first.a]].asked = known_[present_[first.b]].asked = -1;  // to be rebuilt when we wake
    return {std::min(end, now + std::max<Step>(1, roster_.clock.steps_before(first.time)))};
  }
}

std::size_t Sleeping::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(known_) + bytes_of(members_) + bytes_of(present_) + bytes_of(stale_) +
         bytes_of(motions_) + bytes_of(bounds_) + finder_.memory_bytes();
}

}  // namespace

std::unique_ptr<Method> make_sleeping(Roster& roster, const BroadPhaseOptions& options) {
  return std::make_unique<Sleeping>(roster, options);
}

}  // namespace orchard::runtime::detail
