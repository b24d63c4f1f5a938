#include "sleeping.h"

#include <algorithm>

namespace orchard::broad_phase_methods::detail {
namespace {

constexpr Step kLongestSleep = 1000;  // steps: a common end is needed even if no bound expires

IntersectionOptions find_options(SleepingMethod method) {
  switch (method) {
    case SleepingMethod::projection:
      return {.method = IntersectionMethod::projection};
    case SleepingMethod::subdivision:
      return {.method = IntersectionMethod::subdivision};
    case SleepingMethod::hybrid:
      return {.method = IntersectionMethod::hybrid};
    case SleepingMethod::quadratic:
      return {.method = IntersectionMethod::projection, .shape = BoundShape::quadratic};
    case SleepingMethod::horns:
      return {.method = IntersectionMethod::sorted, .shape = BoundShape::horn};
    default:
      return {.method = IntersectionMethod::all_pairs};
  }
}

}  // namespace

Sleeping::Sleeping(BodyPool& pool, const SleepingOptions& options)
    : pool_(pool),
      rebuild_all_(options.rebuild == Rebuild::everything),
      slack_(2 * options.common.position_slack),  // now, and at the start of the bound
      find_(find_options(options.method)) {}

void Sleeping::changed(BodyIndex body) {
  if (known_.size() < pool_.slots()) known_.resize(pool_.slots());
  known_[body].asked = -1;
  members_changed_ = true;
}

void Sleeping::refresh_members() {
  if (!members_changed_) return;
  members_changed_ = false;
  members_.clear();
  for (BodyIndex body = 0; body < pool_.slots(); ++body) {
    if (pool_.alive(body)) members_.push_back(body);
  }
}

void Sleeping::ask(Step now, std::span<const BodyIndex> bodies) {
  motions_.resize(bodies.size());
  pool_.motions.ask(now, bodies, motions_);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Known& known = known_[bodies[i]];
    if (!is_valid(motions_[i])) {
      pool_.motions.refuse(bodies[i]);
      known = {Motion{}, now, now + 1, false};
      continue;
    }
    const Step last = pool_.clock.last_before_expiry(motions_[i].expiry);
    const bool for_ever = last == kNeverStep || pool_.statics.has(bodies[i]);
    known = {motions_[i], now, for_ever ? kNeverStep : std::max(now, last) + 1, true};
  }
}

// Among all bounds that hold, over the same interval, from now until the first one expires.
void Sleeping::find(Step now) {
  present_.clear();
  end_ = now + kLongestSleep;
  for (const BodyIndex body : members_) {
    if (stale(body, now)) continue;
    end_ = std::min(end_, known_[body].end);
    if (known_[body].valid) present_.push_back(body);
  }
  const double duration = pool_.clock.seconds_between(now, end_ - 1);
  bounds_.clear();
  for (const BodyIndex body : present_) {
    const double age = static_cast<double>(now - known_[body].asked) * pool_.clock.time_step;
    bounds_.push_back(make_bound(known_[body].motion, age, duration, slack_));
  }
  const auto may_pair = [this](std::uint32_t a, std::uint32_t b) { return pool_.may_pair({present_[a], present_[b]}); };
  found_ = &finder_.find(bounds_, duration, find_, pool_.filters_pairs() ? BoundFilter(may_pair) : BoundFilter());
}

// Those that touch now have to be of now before anything can be said of the spheres.
bool Sleeping::intersecting_are_current(Step now) {
  bool all = true;
  for (const BoundContact& contact : found_->initial) {
    if (contact.time > 0) continue;
    for (const BodyIndex body : {present_[contact.a], present_[contact.b]}) {
      if (current(body, now)) continue;
      known_[body].asked = -1;
      all = false;
    }
  }
  return all;
}

void Sleeping::report(Step now) {
  reported_.clear();
  for (const BoundContact& contact : found_->initial) {
    const BodyIndex a = present_[contact.a], b = present_[contact.b];
    if (contact.time > 0 || !current(a, now) || !current(b, now)) continue;
    if (spheres_touch(known_[a].motion, known_[b].motion)) reported_.push_back({a, b});
  }
}

// When all are known.
StepReport Sleeping::sleep(Step now) {
  const BoundContact& first = found_->earliest;
  if (first.time == kNoContact) return {end_, reported_};
  known_[present_[first.a]].asked = known_[present_[first.b]].asked = -1;  // to be rebuilt when we wake
  return {std::min(end_, now + std::max<Step>(1, pool_.clock.steps_before(first.time, now))), reported_};
}

StepReport Sleeping::step(Step now, BudgetTracker& tracker) {
  refresh_members();
  if (members_.empty()) return {kNeverStep};
  if (tracker.limited()) return step_within(now, tracker);
  if (rebuild_all_) {
    for (const BodyIndex body : members_) known_[body].asked = -1;
  }
  do {
    stale_.clear();
    for (const BodyIndex body : members_) {
      if (stale(body, now)) stale_.push_back(body);
    }
    ask(now, stale_);
    find(now);
  } while (!intersecting_are_current(now));
  report(now);
  return sleep(now);
}

std::size_t Sleeping::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(known_) + bytes_of(members_) + bytes_of(present_) + bytes_of(stale_) +
         bytes_of(motions_) + bytes_of(bounds_) + bytes_of(pairs_) + bytes_of(reported_) + bytes_of(turns_) +
         finder_.memory_bytes();
}

}  // namespace orchard::broad_phase_methods::detail

namespace orchard::broad_phase_methods {

BroadPhase make_sleeping_broad_phase(MotionSource source, const SleepingOptions& options) {
  const auto make = [&](runtime::detail::BodyPool& pool, const BroadPhaseOptions& common) {
    return std::make_unique<detail::Sleeping>(pool, SleepingOptions{options.method, options.rebuild, common});
  };
  return runtime::detail::make_broad_phase(std::move(source), options.common, make);
}

}  // namespace orchard::broad_phase_methods
