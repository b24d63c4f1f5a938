#include "orchard/runtime/broad_phase.h"

#include <algorithm>
#include <cmath>

#include "broad_phase/broad_phase_state.h"

namespace orchard::runtime {

using detail::kNeverStep;
using detail::Step;

MotionSource values_of(const std::vector<Motion>& values) {
  return [&values](double, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    const Motion none{.radius = -1};  // the radius is not valid, so the body is refused
    for (std::size_t i = 0; i < bodies.size(); ++i) motions[i] = bodies[i] < values.size() ? values[bodies[i]] : none;
  };
}

bool is_valid(const BroadPhaseOptions& options) noexcept {
  constexpr double kMinStep = 1e-20, kMaxStep = 1e20;
  const double step = options.time_step;
  const double slack = options.position_slack;
  return 0 <= slack && slack <= kMaxNumber && kMinStep <= step && step <= kMaxStep &&
         std::fabs(options.start) <= kMaxSteps * step;  // none is NaN
}

BroadPhase::BroadPhase(MotionSource source, const BroadPhaseOptions& options)
    : BroadPhase(std::move(source), options, detail::make_kinetic_broad_phase) {}

BroadPhase::BroadPhase(MotionSource source, const BroadPhaseOptions& wanted, const detail::MakeMethod& make) {
  const bool valid = is_valid(wanted);
  const BroadPhaseOptions options = valid ? wanted : BroadPhaseOptions{};
  state_ = std::make_unique<State>(std::move(source), detail::Clock{options.start, options.time_step});
  max_time_ = valid ? kMaxSteps * options.time_step : -1;
  state_->method = make(state_->pool, options);
  if (options.validate) state_->pool.motions.check_bounds(options.broken, options.position_slack);
  note_next_step();
  seen_time_ = -std::numeric_limits<double>::infinity();
}

BroadPhase detail::make_broad_phase(MotionSource source, const BroadPhaseOptions& options, const MakeMethod& make) {
  return {std::move(source), options, make};
}

BroadPhase::BroadPhase(BroadPhase&&) noexcept = default;
BroadPhase& BroadPhase::operator=(BroadPhase&&) noexcept = default;
BroadPhase::~BroadPhase() = default;

// Returns the last step up to which everything has been reported; -1 if there is none yet.
Step BroadPhase::step_reported() const noexcept {
  return std::isinf(seen_time_) ? -1 : std::max<Step>(-1, state_->pool.clock.step_at(seen_time_));
}

// The caller's time may have advanced since the last step that was processed, so the change counts from the first step
// that has not been reported.
void BroadPhase::wake_for_change() {
  if (state_->woken) return;
  state_->woken = true;
  state_->next = std::min(state_->next, step_reported() + 1);
  note_next_step();
}

void BroadPhase::note_next_step() {
  const detail::Clock& clock = state_->pool.clock;
  const bool any = state_->next != kNeverStep;
  next_time_ = any ? clock.time(state_->next) : std::numeric_limits<double>::infinity();
  wake_time_ = any ? clock.earliest(state_->next) : next_time_;
  // To check bounds, every call has to process the steps up to its time.
  if (state_->pool.motions.check() != nullptr) wake_time_ = -std::numeric_limits<double>::infinity();
}

void BroadPhase::validate_up_to(Step step) {
  if (step <= state_->validated) return;
  state_->validated = step;
  state_->pool.motions.ask_all(step);
}

bool BroadPhase::may_change() const noexcept { return valid() && !state_->busy; }

Advance BroadPhase::process(double t_now, const Budget* budget, std::uint64_t replay) {
  if (!(std::fabs(t_now) <= max_time_) || state_->busy) return {.time = next_time_, .time_refused = true};
  // A step that an exception ends half-way cannot be resumed, and later reports would be wrong. So the broad phase is
  // not valid any more.
  const auto fail = [this] {
    max_time_ = -1;
    next_time_ = wake_time_ = std::numeric_limits<double>::infinity();
  };
  detail::UndoUnlessDone fails(fail);
  const Busy busy(*state_);
  const Advance report = process_steps(t_now, budget, replay);
  fails.done();
  return report;
}

Advance BroadPhase::process_steps(double t_now, const Budget* budget, std::uint64_t replay) {
  State& state = *state_;
  state.woken = false;
  std::vector<BodyIndex>& bodies_refused = state.pool.motions.refused();
  bodies_refused.clear();
  const auto refused = [&]() -> std::span<const BodyIndex> {
    std::sort(bodies_refused.begin(), bodies_refused.end());
    bodies_refused.erase(std::unique(bodies_refused.begin(), bodies_refused.end()), bodies_refused.end());
    return bodies_refused;
  };
  const detail::Clock& clock = state.pool.clock;
  std::uint64_t work = 0;
  const bool validating = state.pool.motions.check() != nullptr;
  while (state.next != kNeverStep && t_now >= clock.earliest(state.next)) {
    const Step now = state.next;
    if (validating) validate_up_to(now);
    detail::BudgetTracker tracker = budget ? detail::BudgetTracker(*budget, replay) : detail::BudgetTracker();
    const detail::StepReport report = state.method->step(now, tracker);
    state.next = report.next;
    work = tracker.done();
    note_next_step();
    if (!report.pairs.empty() || report.incomplete_from != kNoClass) {
      seen_time_ = clock.time(now);
      return {seen_time_, report.pairs, report.incomplete_from, report.left_over, refused(), false, work};
    }
  }
  seen_time_ = std::max(seen_time_, t_now);
  if (validating) validate_up_to(step_reported());
  return {next_time_, {}, kNoClass, 0, refused(), false, work};
}

BodyId BroadPhase::id_of(BodyIndex index) const noexcept {
  const detail::BodyPool& pool = state_->pool;
  return valid() && index < pool.slots() && pool.alive(index) ? pool.id_of(index) : kNoBody;
}

BodyId BroadPhase::add_body(std::uint8_t importance, const BodyFilter& filter, const Motion* place) {
  detail::BodyPool& pool = state_->pool;
  const BodyIndex body = pool.add(importance, filter, place);
  if (body == kNoIndex) return kNoBody;
  const auto undo = [&] { pool.remove(body); };
  detail::UndoUnlessDone undone(undo);
  state_->method->changed(body);
  undone.done();
  wake_for_change();
  return pool.id_of(body);
}

BodyId BroadPhase::add(std::uint8_t importance, const BodyFilter& filter) {
  return may_change() && state_->pool.motions.has_source() ? add_body(importance, filter, nullptr) : kNoBody;
}

BodyId BroadPhase::add_static(const Motion& place, std::uint8_t importance, const BodyFilter& filter) {
  return may_change() && is_valid(place) ? add_body(importance, filter, &place) : kNoBody;
}

bool BroadPhase::remove(BodyId body) {
  if (!may_change() || !contains(body)) return false;
  state_->pool.make_room_to_remove(body.index);
  state_->method->removed(body.index);
  state_->pool.remove(body.index);
  return true;
}

bool BroadPhase::cancel(BodyId body) {
  if (!may_change() || !contains(body)) return false;
  state_->method->changed(body.index);
  state_->pool.motions.forget_bound(body.index);
  wake_for_change();
  return true;
}

bool BroadPhase::move_static(BodyId body, const Motion& place) {
  if (!may_change() || !contains(body) || !state_->pool.statics.has(body.index) || !is_valid(place)) return false;
  cancel(body);
  state_->pool.statics.move(body.index, place);
  return true;
}

bool BroadPhase::set_importance(BodyId body, std::uint8_t importance) {
  if (!may_change() || !contains(body)) return false;
  detail::BodyPool& pool = state_->pool;
  const std::uint8_t before = pool.classes.of(body.index);
  const auto undo = [&] { pool.classes.change(body.index, before); };
  pool.classes.change(body.index, importance);
  detail::UndoUnlessDone undone(undo);
  state_->method->reclassified(body.index);
  undone.done();
  return true;
}

// The change causes a window update, which finds all near pairs of the body again; those found before become void.
bool BroadPhase::set_filter(BodyId body, const BodyFilter& filter) {
  if (!may_change() || !contains(body)) return false;
  detail::BodyPool& pool = state_->pool;
  if (pool.filters.of(body.index) == filter) return true;
  pool.filters.make_room(pool.slots());
  state_->method->changed(body.index);
  wake_for_change();
  pool.filters.set(body.index, filter);
  return true;
}

BodyFilter BroadPhase::filter_of(BodyId body) const noexcept {
  return contains(body) ? state_->pool.filters.of(body.index) : BodyFilter{};
}

void BroadPhase::change_all() {
  const detail::BodyPool& pool = state_->pool;
  for (BodyIndex body = 0; body < pool.slots(); ++body) {
    if (pool.alive(body)) state_->method->changed(body);
  }
}

void BroadPhase::set_pair_filter(PairFilter filter) {
  if (!may_change()) return;
  change_all();
  wake_for_change();
  state_->pool.filters.set_function(std::move(filter));
}

// All bodies are asked for again, so what was due at the steps in between is void.
std::uint64_t BroadPhase::skip_to(double t) {
  if (!may_change() || !(std::fabs(t) <= max_time_)) return 0;
  const Step from = step_reported() + 1, to = state_->pool.clock.step_at(t);
  if (to <= from || state_->next >= to) return 0;
  change_all();
  state_->method->skip();
  state_->next = state_->pool.size() > 0 ? to : kNeverStep;
  state_->woken = true;  // what changes from now on takes part at that step, too
  note_next_step();
  return static_cast<std::uint64_t>(to - from);
}

std::size_t BroadPhase::predict_load(double time, std::span<StepsAhead> steps) const noexcept {
  for (StepsAhead& step : steps) step = {};
  if (!(std::fabs(time) <= max_time_) || state_->busy) return 0;
  return state_->method->predict_load(state_->pool.clock.step_at(time), steps);
}

std::size_t BroadPhase::size() const noexcept { return valid() ? state_->pool.size() : 0; }
std::uint64_t BroadPhase::motions_asked() const noexcept { return state_->pool.motions.asked(); }
std::uint64_t BroadPhase::motion_bound_violations() const noexcept {
  const detail::MotionBoundCheck* const check = state_->pool.motions.check();
  return check == nullptr ? 0 : check->broken();
}
std::size_t BroadPhase::memory_bytes() const noexcept {
  return sizeof(State) + state_->pool.memory_bytes() + state_->method->memory_bytes();
}

}  // namespace orchard::runtime
