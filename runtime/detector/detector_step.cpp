#include <algorithm>
#include <span>
#include <vector>

#include "detector/detector_state.h"
#include "execution/guarded.h"

// A step: the broad phase, then the pairs it reports, in the order of the dissertation's Fig. 3.2.
namespace orchard::runtime {

using detail::is_half_space;
using detail::kNeverStep;
using detail::StepBudget;

namespace {

double nanoseconds(std::chrono::nanoseconds time) noexcept { return static_cast<double>(time.count()); }

}  // namespace

Frame Detector::step(double time, const Budget& budget, const StepOptions& options) noexcept {
  State& s = *state_;
  Frame frame;
  frame.time_refused = s.stepping || !s.valid || !(std::fabs(time) <= kMaxSteps * s.clock.time_step);
  frame.out_of_memory = s.failed;
  if (frame.time_refused || s.failed) return frame;
  s.stepping = true;
  detail::guarded([&] { s.run(time, budget, options, frame); },  // sources and filters throw nothing
                  [&] {
                    s.failed = true;
                    frame = Frame{};
                    frame.out_of_memory = true;
                  });
  s.stepping = false;
  return frame;
}

std::size_t Detector::foresee(std::span<StepLoad> loads) const noexcept {
  const State& s = *state_;
  constexpr std::size_t kMaxAhead = 254;
  std::array<StepsAhead, kMaxAhead> ahead;
  const std::size_t wanted = std::min(loads.size(), kMaxAhead);
  const double now = s.clock.time(s.answered);
  const std::size_t known = s.valid && !s.stepping ? s.broad.foresee(now, std::span(ahead).first(wanted)) : 0;
  s.load_model.predict(std::span(ahead).first(known), s.records.size(), loads);
  for (std::size_t i = 0; i < known; ++i) {
    loads[i].time = s.clock.time(s.answered + 1 + static_cast<State::Step>(i));
  }
  return known;
}

void Detector::State::run(double time, const Budget& given, const StepOptions& with, Frame& frame) {
  event_count = 0, ended.clear(), refused.clear(), broken.clear();
  queries.prepare(shapes, shape_count,
                  options.executor.run == nullptr ? 1 : std::max<std::size_t>(1, options.executor.concurrency) * 4,
                  any_continuous, options.max_fronts);
  StepBudget budget(given, with.replay);
  const Step end = std::max<Step>(-1, clock.step_at(time));
  const std::uint64_t asked_before = broad.motions_asked();
  if (with.latest_only) leave_out_before(end, frame);
  while (watches && answered < end && !full()) {
    watch(answered + 1);
    run_to(answered + 1, end, budget, frame);
  }
  if (!watches) run_to(end, end, budget, frame);
  frame.steps_left = static_cast<std::uint64_t>(std::max<Step>(0, end - answered));
  frame.motions_asked = broad.motions_asked() - asked_before;
  frame.work = budget.spent();
  frame.time = clock.time(std::max<Step>(answered, 0));
  const Step next = records.empty() && !part_search.any() ? halves.next() : answered + 1;
  frame.next_time =
      watches || frame.steps_left > 0
          ? clock.time(answered + 1)
          : std::min(broad.next_time(), next >= kNeverStep - 1 ? std::numeric_limits<double>::infinity()
                                                               : clock.time(std::max(next, answered + 1)));
  std::sort(refused.begin(), refused.end());
  refused.erase(std::unique(refused.begin(), refused.end()), refused.end());
  frame.events = std::span(events).first(event_count), frame.refused = refused, frame.broken = broken;
}

// Nothing was asked for at the steps that are left out, so that no sweep of a continuous body begins there.
void Detector::State::leave_out_before(Step end, Frame& frame) {
  if (end <= answered + 1) return;
  frame.skipped = static_cast<std::uint64_t>(end - 1 - answered);
  broad.skip_to(clock.time(end));
  answered = end - 1;
}

// The steps up to `last` that have anything. `end`: the last step of this call, among which the budget is shared.
void Detector::State::run_to(Step last, Step end, StepBudget& budget, Frame& frame) {
  while (answered < last && !full()) {
    // What overlapped at the step before may be apart at the next; half-spaces are not the broad phase's, nor is what
    // is found by parts.
    const bool under_way = !records.empty() || part_search.any();
    const Step stop = std::min(last, under_way ? answered + 1 : std::max(answered + 1, halves.next()));
    const double time = clock.time(stop);
    const std::uint64_t before = broad.motions_asked();
    StepsAhead next;
    broad.foresee(clock.time(answered), {&next, 1});
    pairs_seen.meetings = static_cast<double>(next.meetings);
    Advance now{};
    StepBudget share = budget.share(static_cast<std::uint64_t>(end - answered));
    if (!budget.limited()) {
      if (stop == answered + 1) ask_all(stop);
      now = broad.advance(time);
      all_asked = false;
    } else {
      Budget work;
      if (budget.limited_in_work()) work.work = std::max<std::uint64_t>(1, share.left() / (2 * kMotionWork));
      if (share.timed()) work.time = load_model.time_for_broad(share.time_left(), records.size());
      const StepBudget::Stopwatch watch(share.timed());
      now = broad.advance(time, work, share.replay() != nullptr ? share.replay()->broad : 0);
      if (share.timed() && now.incomplete_from != kNoClass)
        load_model.learn_broad_excess(watch.passed() - nanoseconds(work.time));
      if (now.incomplete_from != kNoClass) share.cut_broad(now.work);
    }
    const std::uint64_t asked = (broad.motions_asked() - before) * kMotionWork;
    share.spend(asked);
    note_refused(now.refused);
    frame.incomplete_from = std::min(frame.incomplete_from, now.incomplete_from);
    frame.left_over += now.left_over;
    const bool found = !now.pairs.empty() || now.incomplete_from != kNoClass;
    const Step step = found ? std::llround((now.time - clock.start) / clock.time_step) : stop;
    if (found || under_way || halves.next() <= step) answer(step, now, share, frame);
    interrupted = now.incomplete_from != kNoClass;
    budget.spend(share.spent());
    frame.cut = share.cut();
    answered = step;
  }
}

// Both bodies are those of before.
bool Detector::State::still_there(const detail::RecordTable::Known& known) const noexcept {
  const auto there = [this](BodyIndex body) { return bodies[body].id != kNoBody; };
  const auto generation = [this](BodyIndex body) { return bodies.whereabouts(body).generation; };
  return there(known.pair.a) && there(known.pair.b) &&
         known.generations == generation(known.pair.a) + generation(known.pair.b);
}

// The pairs of the step, in ascending order: the broad phase's, those with half-spaces, those found by parts, and those
// known before that an interrupted broad phase may have left out.
void Detector::State::gather(Step step, const Advance& now) {
  pairs.clear();
  due.clear();
  halves.due(step, due);
  if (!due.empty()) {
    bodies.ask(step, clock.time(step), due, options.executor);
    due_motions.clear();
    for (const BodyIndex body : due) due_motions.push_back(promise_of(body, clock.time(step)));
    halves.update_windows(step, clock, due, bodies, due_motions, clock.time_step, options.position_slack,
                          pairs.with_planes);
  }
  if (now.incomplete_from != kNoClass) {
    auto reported = now.pairs.begin();
    for (std::size_t place = 0; place < records.size(); ++place) {
      const BodyPair& pair = records.pair(place);
      if (is_half_space(pair.b) || found_by_parts(pair)) continue;
      while (reported != now.pairs.end() && *reported < pair) ++reported;
      if (reported != now.pairs.end() && *reported == pair) continue;
      if (still_there(records.known(place))) pairs.kept.push_back(pair);
    }
    involved.clear();
    for (const BodyPair& pair : pairs.kept) involved.push_back(pair.a), involved.push_back(pair.b);
    bodies.ask(step, clock.time(step), involved);
    std::erase_if(pairs.kept, [&](const BodyPair& pair) { return bodies.surely_apart(pair, clock.time_step); });
  }
  find_part_pairs(step);
  pairs.merge(now.pairs);
  ask_involved(step);
}

// Those that are in pairs. Where everybody has been asked and nobody is to be refused, who they are only matters for
// what is done at the next steps.
void Detector::State::ask_involved(Step step) {
  constexpr Step kKept = 16;
  if (all_asked_at == step && bodies.all_valid() && step < involved_at + kKept) return;
  involved_at = step;
  involved.clear();
  detail::grow(is_involved, bodies.slots());
  const auto involve = [&](BodyIndex body) {
    if (is_involved[body] != 0) return;
    involved.push_back(body);
    is_involved[body] = 1;
  };
  BodyIndex last = kNoIndex;
  for (const BodyPair& pair : pairs.all()) {
    if (pair.a != last) involve(last = pair.a);
    if (!is_half_space(pair.b)) involve(pair.b);
  }
  for (const BodyIndex body : involved) is_involved[body] = 0;
  bodies.ask(step, clock.time(step), involved, options.executor);
  for (const BodyIndex body : involved) {
    if (!bodies[body].valid) refused.push_back(body);
  }
}

void Detector::State::answer(Step step, const Advance& now, StepBudget& budget, Frame& frame) {
  const StepBudget::Stopwatch watch(budget.timed());
  gather(step, now);
  match(step, frame);
  rounds.use(options.executor);
  const std::uint64_t before = budget.spent();
  const bool sweeps_or_ends = any_continuous || any_jumped;
  any_jumped = false;
  if (budget.limited()) {
    open_records(step);
    answer_within(step, watch, budget, frame);
    load_model.learn_pairs(pairs_seen, budget.spent() - before, pairs.all().size());
  } else {
    if (sweeps_or_ends) {
      open_records(step);
      budget.spend(rounds.answer_all(records, open, step));
      rounds.sweep_all(records, open, step, budget);
      tally_all();
    } else {
      budget.spend(answer_one_by_one(step));
    }
    load_model.learn_pairs(pairs_seen, budget.spent() - before, pairs.all().size());
    report(step, frame);
  }
  choose_part_searches(step);
  ++frame.steps;
}

// With time set aside for what follows, and half of the rest for sweeps if there are any.
void Detector::State::answer_within(Step step, const StepBudget::Stopwatch& watch, StepBudget& budget, Frame& frame) {
  const std::size_t known = records.size();
  const StepBudget::Part report_time{0, load_model.time_to_report(known)};
  if (budget.timed()) budget.set_aside(report_time);
  rounds.begin_within(records, open, step);
  const double begun = watch.passed();
  const StepBudget::Part for_sweeps = rounds.sweeps(records, open) ? budget.half() : StepBudget::Part{};
  budget.set_aside(for_sweeps);
  rounds.answer_within(records, budget);
  budget.give_back(for_sweeps);
  const StepBudget::Stopwatch rest(budget.timed());
  rounds.fold(records, open, step);
  const double folded = rest.passed();
  rounds.sweep_all(records, open, step, budget);
  const double swept = rest.passed();
  tally_all();
  report(step, frame);
  if (!budget.timed()) return;
  budget.give_back(report_time);
  load_model.learn_times(begun, folded + rest.passed() - swept, known);
}

}  // namespace orchard::runtime
