#include "broad_phase/kinetic_broad_phase.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace orchard::runtime::detail {
namespace {

constexpr double kManyPairs = 0.5;                    // near pairs per body from which on it pays to note spheres
constexpr std::size_t kMinBodiesAtCommonExpiry = 32;  // so many bodies are worth another step
// In shorter windows, updating half of the bodies ahead would cost half an update more for each window.
constexpr Step kMinStepsBeforeCommonExpiry = 4;
constexpr std::size_t kAskedAhead = 8;  // bodies that are asked whether their next bounds are known
constexpr Step kNotSorted = 256;        // steps without sorting after one for which it was not suitable

}  // namespace

KineticBroadPhase::KineticBroadPhase(BodyPool& pool, const BroadPhaseOptions& options)
    : state_(pool, options),
      planner_(pool, state_.options),
      pairs_(state_),
      updates_(state_, pairs_),
      budgeted_(state_, pairs_, updates_) {}

void KineticBroadPhase::changed(BodyIndex body) {
  constexpr std::size_t kAtOnce = 64;
  if (state_.windows.size() < state_.pool.slots()) state_.make_room(state_.windows.size() + kAtOnce);
  state_.changes.note(body);
}

// The next step removes the box of the body, together with those of other bodies that are gone.
void KineticBroadPhase::removed(BodyIndex body) {
  budgeted_.leave(body);
  state_.changes.note(body);
  state_.overlaps.mark(body, OverlapList::kUpdated);
}

// Makes the bodies due that have changed or were added. The boxes of bodies that are gone leave the grid together.
void KineticBroadPhase::take_changes() {
  const bool all_alive = state_.pool.size() == state_.pool.slots();
  const auto load = [&](BodyIndex body) { prefetch(&state_.windows[body]); };
  const auto tell_planner = [&](BodyIndex body) {
    const Window& window = state_.windows[body];
    if (window.bounded && window.end >= 0) planner_.note_cancelled();
  };
  if (all_alive && state_.changes.size() == state_.pool.size()) {  // all bodies, as at the first step
    state_.changes.take(load, tell_planner);
    return all_are_due();
  }
  std::size_t count = due_.bodies.size(), gone = count + state_.changes.size();  // those that are gone, from the end on
  make_room(due_.bodies, gone);
  due_.bodies.resize(gone);
  state_.changes.take(load, [&](BodyIndex body) {
    tell_planner(body);
    if (all_alive || state_.pool.alive(body)) {
      due_.bodies[count++] = body;
      return;
    }
    due_.bodies[--gone] = body;
    state_.windows[body].end = kNeverStep;  // no update is due until another body gets the slot
    state_.windows.void_events(body);
  });
  state_.boxes.take_away(std::span(due_.bodies).subspan(gone));
  due_.bodies.resize(count);
}

void KineticBroadPhase::collect_due(Step now) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < due_.entries.size(); ++i) {
    if (i + kAhead < due_.entries.size()) {
      const BodyIndex body = due_.entries[i + kAhead];
      prefetch(&state_.windows[body]), prefetch(state_.boxes.at(body)), prefetch(state_.changes.at(body));
    }
    Window& window = state_.windows[due_.entries[i]];
    if (window.end != now || state_.changes.has(due_.entries[i])) continue;  // void, or among the changes
    window.end = kUpdateDue;
    due_.bodies.push_back(due_.entries[i]);
  }
  take_changes();
}

// Adds the bodies that have changed since the step before, or were added, to due_.bodies, which already has those that
// were not updated ahead. Those that are gone leave it.
void KineticBroadPhase::complete_due() {
  if (state_.changes.empty() && state_.pool.size() == state_.pool.slots()) return;  // and no body is gone
  std::erase_if(due_.bodies, [&](BodyIndex body) { return !state_.pool.alive(body) || state_.changes.has(body); });
  const std::size_t before = due_.bodies.size();
  take_changes();
  state_.boxes.take_away(std::span(due_.bodies).subspan(before));
}

// Returns whether to rebuild all boxes. If at least half of the bodies are due, that is cheaper, and it lets the plan
// follow the bodies. If most of the others are due at the next step, a quarter suffices; otherwise prepare() would
// update those that are due now once more.
bool KineticBroadPhase::worth_a_rebuild(Step now, std::size_t due) const noexcept {
  const std::size_t n = state_.pool.size(), parts = common_expiry_ == now + 1 ? 4 : 2;
  if (state_.windows.rounds_run_out()) return true;  // rounds of bodies that seldom update have to stay comparable
  if (due == 0 || n == 0) return false;
  return parts * due >= n || planner_.many_more_bodies() || planner_.crowded(state_.counts);
}

// Makes a new plan and a new grid if the old ones do not fit any more. Returns false if a budget interrupted it.
bool KineticBroadPhase::replan(Step now, BudgetTracker& tracker) {
  GridCounts counts = state_.counts;
  if (sorting_) {  // if boxes of balls of one size meet, the balls touch in this share of the cases
    constexpr double kBallOfBox = std::numbers::pi / 6;
    const double met = static_cast<double>(sorted_.pairs().size()) / kBallOfBox;
    counts = {.bodies = state_.pool.size(), .pairs = static_cast<std::uint64_t>(met)};
  }
  const Planner::Outcome outcome = planner_.replan(now, counts, tracker);
  if (outcome == Planner::Outcome::interrupted) return false;
  state_.counts = {};
  if (outcome == Planner::Outcome::same) return true;
  state_.grid = QuantizedGrid(planner_.spread().middle, planner_.velocity(), planner_.plan().cell_size,
                              2 * state_.options.position_slack, state_.pool.clock, now);
  state_.windows.plan(planner_.plan().window, state_.grid.moves());
  return true;
}

void KineticBroadPhase::all_are_due() {
  if (due_.bodies.capacity() > 2 * state_.pool.size()) give_back(due_.bodies);
  due_.bodies.resize(state_.pool.size());
  if (state_.pool.size() == state_.pool.slots()) return std::iota(due_.bodies.begin(), due_.bodies.end(), BodyIndex{0});
  std::size_t count = 0;
  for (BodyIndex body = 0; count < due_.bodies.size(); ++body) {
    due_.bodies[count] = body;
    count += state_.pool.alive(body) ? 1 : 0;
  }
}

void KineticBroadPhase::place_all() {
  if (sorting_) sorted_.release();
  sorting_ = false;
  state_.wheel.clear_bodies();
  state_.windows.start_over();
  state_.boxes.rebuild(state_.pool.slots(), planner_.plan().lines, state_.options.executor);
  all_are_due();
}

void KineticBroadPhase::note_spheres() {
  const WindowPlan& plan = planner_.plan();
  pairs_.spheres().begin(plan.slow && plan.pairs_per_body >= kManyPairs, state_.pool.slots());
}

void KineticBroadPhase::make_room_for_boxes() {
  state_.boxes.make_room_for_boxes(state_.pool.slots());
  pairs_.spheres().make_room(state_.pool.slots());
}

// Does everything that is due, and what budgets have left over. `completing`: a part of the updates was done one step
// ahead.
void KineticBroadPhase::step_in_full(Step now, bool completing) {
  if (!budgeted_.nothing_left()) {
    for (const BodyIndex body : due_.bodies) budgeted_.leave(body);  // changed while it waited: one update is enough
    budgeted_.take_all(due_.bodies, due_.pairs);
  }
  bool rebuild_all = completing;
  if (!completing) {
    rebuild_all = sorting_ || worth_a_rebuild(now, due_.bodies.size());
    if (rebuild_all) {
      BudgetTracker unlimited;
      replan(now, unlimited);
      if (worth_sorting(now)) return step_by_sorting(now);
      place_all();
      state_.wheel.clear_events();  // updates of all windows void them
    } else {
      make_room_for_boxes();
      state_.boxes.take_away(due_.bodies);
    }
  }
  make_room_for_boxes();
  if (rebuild_all) {
    state_.overlaps.start_over();
    note_spheres();
  }
  rebuild_all ? updates_.update_all(now, now, due_.bodies) : updates_.update(now, now, due_.bodies);
  std::erase_if(due_.pairs, [&](const PairEvent& event) { return !state_.windows.valid(event); });
  pairs_.test(now, due_.pairs);
  pairs_.take_overlaps_ahead();
  if (!rebuild_all) return;
  common_expiry_ = planner_.plan().window >= kMinStepsBeforeCommonExpiry ? find_common_expiry(now) : kNeverStep;
}

// Returns the step at which most windows end, if these are many; otherwise kNeverStep.
Step KineticBroadPhase::find_common_expiry(Step now) const noexcept {
  for (Step step = state_.wheel.next_after(now); step != kNeverStep; step = state_.wheel.next_after(step)) {
    const std::size_t bodies = state_.wheel.bodies_due(step);
    if (bodies >= kMinBodiesAtCommonExpiry && 2 * bodies > state_.pool.size()) return step;
    if (step >= now + kLongestWindow - 1) break;
  }
  return kNeverStep;
}

// Does as much as the budget allows. A rebuild removes all boxes. It is necessary after sorting, when rounds run out,
// and if there are many more bodies than were planned for. If it only saves time, it is done only if no budget has
// interrupted a step for as long as a window lasts; otherwise, nothing would ever be finished.
unsigned KineticBroadPhase::step_within(Step now, BudgetTracker& tracker) {
  const bool calm = now - interrupted_at_ > kLongestWindow;
  const bool has_to = sorting_ || state_.windows.rounds_run_out();
  const bool rebuild = has_to || planner_.many_more_bodies() || (calm && worth_a_rebuild(now, due_.bodies.size()));
  budgeted_.join(due_.bodies, due_.pairs);
  due_.bodies.clear();
  if (rebuild) {
    if (!replan(now, tracker)) return state_.pool.classes.next(0);
    place_all();
    budgeted_.postpone(due_.bodies);
    due_.bodies.clear();
    common_expiry_ = kNeverStep;
  }
  make_room_for_boxes();
  return budgeted_.work(now, tracker);
}

// Returns whether to sort the spheres instead of using boxes. Static bodies have windows without end, which are worth
// keeping if more than half of the bodies are static.
bool KineticBroadPhase::worth_sorting(Step now) const noexcept {
  return planner_.plan().window == 1 && state_.pool.slots() > kFewBodies && now >= sorts_from_ &&
         2 * state_.pool.statics.count() <= state_.pool.size();
}

void KineticBroadPhase::begin_sorting() {
  sorting_ = true;
  common_expiry_ = kNeverStep;
  state_.wheel.clear();
  pairs_.forget_all();
  pairs_.spheres().release();
  state_.boxes.rebuild(state_.pool.slots(), 0, {});
  state_.counts = {};
}

void KineticBroadPhase::step_by_sorting(Step now) {
  if (!sorting_) begin_sorting();
  state_.windows.start_over();
  all_are_due();
  sorted_.begin(due_.bodies.size(), state_.grid.at(now).origin(), planner_.spread().spacing);
  for (std::size_t done = 0; done < due_.bodies.size(); done += kBlock) {
    auto block = std::span(due_.bodies).subspan(done, std::min(kBlock, due_.bodies.size() - done));
    const std::span<const Motion> motions = updates_.ask_valid(now, block);
    for (const BodyIndex body : block) state_.windows.set(body, now + 1);
    sorted_.add(block, motions);
  }
  sorted_.find();
  if (state_.pool.filters_pairs())
    sorted_.drop_pairs([&](const BodyPair& pair) { return !state_.pool.may_pair(pair); });
  state_.overlaps.start_over(sorted_.pairs());
  if (!sorted_.suits()) sorts_from_ = now + kNotSorted;
}

// Does about half of the updates of the common expiry one step ahead. The present bounds have answered for this step,
// and hold no longer than that. If the next ones are known already, the updates are done now, with windows that begin
// at the common expiry; otherwise, it returns false.
bool KineticBroadPhase::prepare(Step now) {
  const Step from = now + 1;
  common_expiry_ = kNeverStep;
  std::array<BodyIndex, kAskedAhead> sample;
  std::size_t count = 0;
  const std::size_t stride = std::max<std::size_t>(1, state_.pool.slots() / kAskedAhead);
  for (std::size_t body = 0; body < state_.pool.slots() && count < kAskedAhead; body += stride) {
    if (state_.pool.alive(static_cast<BodyIndex>(body))) sample[count++] = static_cast<BodyIndex>(body);
  }
  if (!updates_.know_mostly(now, from, std::span(sample).first(count))) return false;

  common_expiry_ = from;
  prepared_ = true;
  pairs_.work_ahead(true);
  state_.windows.begin_round();
  BudgetTracker unlimited;
  replan(now, unlimited);
  place_all();
  state_.wheel.clear_events();
  const auto ahead = static_cast<std::size_t>(planner_.share_ahead() * static_cast<double>(due_.bodies.size()));
  note_spheres();
  updates_.update_all(now, from, std::span(due_.bodies).first(ahead));
  due_.bodies.erase(due_.bodies.begin(), due_.bodies.begin() + static_cast<std::ptrdiff_t>(ahead));
  pairs_.work_ahead(false);
  return true;
}

// Without bodies, nothing is left to plan for or to wake up for.
void KineticBroadPhase::forget_all() noexcept {
  state_.wheel.clear();
  state_.overlaps.clear();
  pairs_.forget_all();
  due_.bodies.clear();
  planner_.forget_survey();
  prepared_ = false;
  common_expiry_ = kNeverStep;
}

void KineticBroadPhase::begin(Step now) {
  state_.windows.begin_round();
  due_.entries.clear();
  due_.pairs.clear();
  state_.wheel.take(now, due_.entries, due_.pairs);
  if (prepared_) return complete_due();
  due_.bodies.clear();
  collect_due(now);
  if (sorting_) all_are_due();  // all windows had one step
}

StepReport KineticBroadPhase::step(Step now, BudgetTracker& tracker) {
  if (state_.pool.size() == 0) {
    take_changes();
    forget_all();
    return {kNeverStep, {}};
  }
  pairs_.begin_step(tracker.limited());
  begin(now);
  const bool completing = prepared_;
  prepared_ = false;
  if (!tracker.limited()) {
    step_in_full(now, completing);
    state_.overlaps.update(state_.pool.slots());
    return end(now, kNoClass, tracker);
  }
  pairs_.take_overlaps_ahead(due_.pairs);
  const unsigned incomplete_from = step_within(now, tracker);
  if (incomplete_from != kNoClass) interrupted_at_ = now;
  pairs_.keep_doubtful();
  state_.overlaps.update(state_.pool.slots());
  return end(now, incomplete_from, tracker);
}

StepReport KineticBroadPhase::end(Step now, unsigned incomplete_from, const BudgetTracker& tracker) {
  StepReport report{now + 1, state_.overlaps.pairs()};
  if (state_.wheel.crowded(state_.pool.size())) {  // for example, if bounds are cancelled again and again
    const auto end_of = [&](BodyIndex body) -> Step& { return state_.windows[body].end; };
    state_.wheel.tidy(now, end_of, [&](const PairEvent& event) { return state_.windows.valid(event); });
  }
  if (incomplete_from != kNoClass) {
    report.incomplete_from = incomplete_from;
    report.left_over = budgeted_.left_over();
    return report;
  }
  if (now + 1 == common_expiry_ && !tracker.limited() && prepare(now)) return report;
  if (!state_.changes.empty() || !report.pairs.empty() || sorting_) return report;
  report.next = state_.wheel.next_after(now);
  if (common_expiry_ != kNeverStep && common_expiry_ - 1 > now) report.next = std::min(report.next, common_expiry_ - 1);
  return report;
}

std::size_t KineticBroadPhase::predict_load(Step now, std::span<StepsAhead> steps) const noexcept {
  const std::size_t known = std::min<std::size_t>(steps.size(), kWheelSteps - 2);
  if (sorting_ && known > 0) steps[0].updates += state_.pool.size();
  for (std::size_t i = 0; i < known; ++i) {
    const Step step = now + 1 + static_cast<Step>(i);
    steps[i].updates += state_.wheel.bodies_due(step);
    steps[i].meetings += state_.wheel.events_due(step);
    steps[i].overlaps += state_.overlaps.pairs().size();
  }
  return known;
}

// Appends the bodies that have no box, or an old one, and may be anywhere: new ones, cancelled ones, those that wait
// for a budget, and those that are updated at the step after this one.
void KineticBroadPhase::append_loose(std::vector<BodyIndex>& bodies) const {
  state_.changes.append_to(bodies);
  budgeted_.append_bodies(bodies);
  if (prepared_) bodies.insert(bodies.end(), due_.bodies.begin(), due_.bodies.end());
}

Near KineticBroadPhase::near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const {
  append_loose(bodies);
  if (!sorting_) return state_.boxes.near_box(state_.grid.at(now), lower, upper, bodies);
  return sorted_.append_near(lower, upper, bodies) ? Near::some : Near::untold;
}

bool KineticBroadPhase::along(Step now, const Vec3& origin, const Vec3& way, double length,
                              std::vector<BodyIndex>& portion, const VisitPortion& visit) const {
  portion.clear();
  append_loose(portion);
  return !sorting_ && state_.boxes.along(state_.grid.at(now), origin, way, length, portion, visit);
}

std::size_t KineticBroadPhase::memory_bytes() const noexcept {
  return sizeof(*this) + state_.memory_bytes() + planner_.memory_bytes() + pairs_.memory_bytes() +
         updates_.memory_bytes() + budgeted_.memory_bytes() + sorted_.memory_bytes() +
         bytes_of(due_.bodies, due_.entries, due_.pairs);
}

std::unique_ptr<BroadPhaseAlgorithm> make_kinetic_broad_phase(BodyPool& pool, const BroadPhaseOptions& options) {
  return std::make_unique<KineticBroadPhase>(pool, options);
}

}  // namespace orchard::runtime::detail
