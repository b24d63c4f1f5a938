#include "detector/detector_state.h"

// The pairs of a step, matched with those of the step before, answered and reported.
namespace orchard::runtime {

using detail::ActivePairs;
using detail::CachedPair;
using detail::StepBudget;

void Detector::State::answer(Step step, const Advance& now, StepBudget& budget, Frame& frame) {
  const StepBudget::Stopwatch watch(budget.timed());
  matcher.gather(step, now);
  matcher.match([&](CachedPair& pair) {
    // What the filters exclude is no pair of the broad phase's any more.
    const bool there = matcher.is_there(pair) && matcher.allowed(pair);
    return reporter.part(pair, there, there && matcher.has_jumped(pair), step);
  });
  const ActivePairs active = skipper.find_active(matcher.cache());
  frame.pairs += matcher.pair_count();
  frame.certain += matcher.pair_count() - active.size();
  const std::uint64_t before = budget.spent();
  const bool sweeps_or_ends = world.any.continuous || world.any.jump;
  world.any.jump = false;
  if (budget.limited()) {
    open_pairs(active, step);
    answer_within(active, step, watch, budget, frame);
  } else if (sweeps_or_ends) {
    open_pairs(active, step);
    budget.spend(scheduler.answer_all(matcher.cache(), open.pairs, step));
    scheduler.sweep_all(matcher.cache(), open.pairs, step, budget);
    reporter.conclude_all(active);
    reporter.report(active, step, frame);
  } else {
    budget.spend(answer_one_by_one(active, step));
    reporter.report(active, step, frame);
  }
  load_model.learn_pairs(matcher.seen(), budget.spent() - before, matcher.pair_count());
  part_pairs.choose(step, matcher.cache());
  ++frame.steps;
}

// With time set aside for what follows, and half of the rest for sweeps if there are any.
void Detector::State::answer_within(const ActivePairs& active, Step step, const StepBudget::Stopwatch& watch,
                                    StepBudget& budget, Frame& frame) {
  detail::PairCache& cache = matcher.cache();
  const std::size_t known = cache.size();
  const StepBudget::Part report_time{0, load_model.time_to_report(known)};
  if (budget.timed()) budget.set_aside(report_time);
  scheduler.begin_within(cache, open.pairs, step);
  const double begun = watch.passed();
  const StepBudget::Part for_sweeps = scheduler.sweeps(cache, open.pairs) ? budget.half() : StepBudget::Part{};
  budget.set_aside(for_sweeps);
  scheduler.answer_within(cache, budget);
  budget.give_back(for_sweeps);
  const StepBudget::Stopwatch rest(budget.timed());
  scheduler.fold(cache, open.pairs, step);
  const double folded = rest.passed();
  scheduler.sweep_all(cache, open.pairs, step, budget);
  const double swept = rest.passed();
  reporter.conclude_all(active);
  reporter.report(active, step, frame);
  if (!budget.timed()) return;
  budget.give_back(report_time);
  load_model.learn_times(begun, folded + rest.passed() - swept, known);
}

// The application's own filter belongs to this thread.
void Detector::State::ask_filter(const ActivePairs& active) {
  for (std::size_t i = 0; world.filter && i < active.size(); ++i) matcher.allowed(matcher.cached(active.known(i)));
}

// Which of the active pairs have to be asked about.
void Detector::State::open_pairs(const ActivePairs& active, Step step) {
  constexpr std::size_t kPerJob = 512;
  enum : std::uint8_t { kOpens = 1, kOver = 2 };
  open.pairs.clear();
  detail::grow(open.marks, active.size());
  ask_filter(active);
  auto look_at_some = [&](std::size_t job) {
    const std::size_t end = std::min(active.size(), (job + 1) * kPerJob);
    for (std::size_t i = job * kPerJob; i < end; ++i) {
      active.prefetch(i, end);
      CachedPair& pair = matcher.cached(active.known(i));
      matcher.allowed(pair);
      bool over = false;
      const bool asked = skipper.needs_answer(pair, step, interrupted, over);
      open.marks[i] = static_cast<std::uint8_t>((asked ? kOpens : 0) | (over ? kOver : 0));
    }
  };
  run_jobs(world.options.executor, (active.size() + kPerJob - 1) / kPerJob, look_at_some);
  for (std::size_t i = 0; i < active.size(); ++i) {
    if ((open.marks[i] & kOver) != 0) reporter.end_by_teleport(active.cached(i), step);
    if ((open.marks[i] & kOpens) != 0) open.pairs.push_back(active.known(i).record);
  }
}

// Where nothing has to wait for all answers: pairs are opened, answered and concluded one after the other.
std::uint64_t Detector::State::answer_one_by_one(const ActivePairs& active, Step step) {
  const std::size_t jobs = scheduler.jobs(active.size());
  reporter.begin_jobs(active, jobs);
  ask_filter(active);
  return scheduler.answer_by(jobs, [&](std::size_t job, detail::QueryPool::Scratch& scratch) {
    detail::EventReporter::Tally& tally = reporter.tally(job);
    tally = {};
    const std::size_t end = reporter.first_of_job(active, job + 1);
    for (std::size_t i = reporter.first_of_job(active, job); i < end; ++i) {
      active.prefetch(i, end);
      CachedPair& pair = matcher.cached(active.known(i));
      matcher.allowed(pair);
      bool over = false;
      if (skipper.needs_answer(pair, step, interrupted, over)) scheduler.answer(pair, step, scratch);
      reporter.conclude(active, i, tally);
    }
  });
}

}  // namespace orchard::runtime
