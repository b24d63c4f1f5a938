#include "detector/detector_state.h"

// Matches the pairs of a step with those of the step before, answers them and reports the events.
namespace orchard::runtime {

using detail::ActivePairs;
using detail::CachedPair;
using detail::StepBudget;

void Detector::State::answer(Step step, const Advance& now, StepBudget& budget, Frame& frame) {
  const double begun = budget.clock();
  matcher.gather(step, now);
  matcher.match([&](CachedPair& pair) {
    // The broad phase no longer reports a pair that the filters exclude, so such a pair comes here, too.
    const bool there = matcher.is_there(pair) && matcher.allowed(pair);
    return reporter.part(pair, there, there && matcher.has_jumped(pair), step);
  });
  const ActivePairs active = skipper.find_active(matcher.cache());
  frame.pairs += matcher.pair_count();
  frame.certain += matcher.pair_count() - active.size();
  const std::uint64_t before = budget.spent();
  begin_pairs(active, step);
  if (budget.limited()) {
    answer_within(active, step, begun, budget, frame);
  } else {
    budget.spend(scheduler.each(active.size(), [&](std::size_t i, detail::AnswerScratch& scratch) {
      active.prefetch(i);
      CachedPair& pair = matcher.cached(active.known(i));
      matcher.allowed(pair);
      if (skipper.needs_answer(pair, step, interrupted)) scheduler.answerer().answer(pair, step, scratch);
      reporter.conclude(active, i);
    }));
    reporter.report(active, step, frame);
  }
  load_model.learn_pairs(matcher.seen(), budget.spent() - before, matcher.pair_count());
  part_pairs.choose(step, matcher.cache());
  ++frame.steps;
}

// Does what only the calling thread may do: asks the application's own filter, and ends touches of bodies that were
// teleported.
void Detector::State::begin_pairs(const ActivePairs& active, Step step) {
  reporter.begin_step(active);
  const bool jumps = std::exchange(world.any.jump, false);
  for (std::size_t i = 0; (world.filter || jumps) && i < active.size(); ++i) {
    CachedPair& pair = matcher.cached(active.known(i));
    if (matcher.allowed(pair) && pair.touching && matcher.has_jumped(pair)) reporter.end_by_teleport(pair, step);
  }
}

// Answers the active pairs within the budget. It sets aside the time that the work after the answers takes and, if any
// pair has to be swept, half of what is left then.
void Detector::State::answer_within(const ActivePairs& active, Step step, double begun, StepBudget& budget,
                                    Frame& frame) {
  detail::PairCache& cache = matcher.cache();
  bool sweeps = false;
  open_pairs.clear();
  for (std::size_t i = 0; i < active.size(); ++i) {
    active.prefetch(i);
    CachedPair& pair = matcher.cached(active.known(i));
    matcher.allowed(pair);
    if (!skipper.needs_answer(pair, step, interrupted)) continue;
    open_pairs.push_back(active.known(i).record);
    sweeps = sweeps || pair.sweep.possible;
  }
  const std::size_t known = cache.size();
  const StepBudget::Part report_time{0, load_model.time_to_report(known)};
  if (budget.timed()) budget.set_aside(report_time);
  scheduler.begin_within(cache, open_pairs);
  const double chooses = budget.clock();
  const StepBudget::Part for_sweeps = sweeps ? budget.part(2) : StepBudget::Part{};
  budget.set_aside(for_sweeps);
  scheduler.answer_within(cache, budget);
  budget.give_back(for_sweeps);
  const double answered = budget.clock();
  scheduler.fold(cache, open_pairs, step);
  const double folded = budget.clock();
  scheduler.sweep_within(cache, open_pairs, step, budget);
  const double swept = budget.clock();
  scheduler.each(active.size(), [&](std::size_t i, detail::AnswerScratch&) {
    active.prefetch(i);
    reporter.conclude(active, i);
  });
  reporter.report(active, step, frame);
  if (!budget.timed()) return;
  budget.give_back(report_time);
  load_model.learn_times(chooses - begun, folded - answered + budget.clock() - swept, known);
}

}  // namespace orchard::runtime
