#include "detector/detector_state.h"
#include "execution/guarded.h"

// A call of step() runs the steps up to a time. Each step first advances the broad phase, and then answers the pairs.
namespace orchard::runtime {

using detail::kNeverStep;
using detail::StepBudget;

Frame Detector::step(double time, const Budget& budget, const StepOptions& options) noexcept {
  State& s = *state_;
  Frame frame;
  frame.time_refused = s.stepping || !s.valid || !(std::fabs(time) <= kMaxSteps * s.world.clock.time_step);
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

std::size_t Detector::predict_load(std::span<StepLoad> loads) const noexcept {
  const State& s = *state_;
  constexpr std::size_t kMaxAhead = 254;
  std::array<StepsAhead, kMaxAhead> ahead;
  const std::size_t wanted = std::min(loads.size(), kMaxAhead);
  const double now = s.world.clock.time(s.world.answered);
  const std::size_t known = s.valid && !s.stepping ? s.broad.predict_load(now, std::span(ahead).first(wanted)) : 0;
  s.load_model.predict(std::span(ahead).first(known), s.matcher.cache().size(), loads);
  for (std::size_t i = 0; i < known; ++i) {
    loads[i].time = s.world.clock.time(s.world.answered + 1 + static_cast<State::Step>(i));
  }
  return known;
}

void Detector::State::run(double time, const Budget& given, const StepOptions& with, Frame& frame) {
  reporter.begin_call();
  sampler.begin_call();
  scheduler.prepare();
  const Step& answered = world.answered;
  StepBudget budget(given, with.replay);
  const Step end = std::max<Step>(-1, world.clock.step_at(time));
  const std::uint64_t asked_before = broad.motions_asked();
  if (with.latest_only) leave_out_before(end, frame);
  while (sampler.watches() && answered < end && !reporter.full()) {
    sampler.watch(answered + 1);
    run_to(answered + 1, end, budget, frame);
  }
  if (!sampler.watches()) run_to(end, end, budget, frame);
  frame.unfinished.steps_left = static_cast<std::uint64_t>(std::max<Step>(0, end - answered));
  frame.motions_asked = broad.motions_asked() - asked_before;
  frame.work = budget.spent();
  frame.time = world.time_of_last_step();
  frame.next_time = next_time(frame.unfinished.steps_left > 0);
  sampler.report(frame);
  frame.events = reporter.events();
}

double Detector::State::next_time(bool steps_left) const noexcept {
  const Step answered = world.answered, next = matcher.idle() ? world.half_space_times.next() : answered + 1;
  if (sampler.watches() || steps_left) return world.clock.time(answered + 1);
  return std::min(broad.next_time(), next >= kNeverStep - 1 ? std::numeric_limits<double>::infinity()
                                                            : world.clock.time(std::max(next, answered + 1)));
}

// The steps that are left out sample no states, so no sweep of a continuous body begins at them.
void Detector::State::leave_out_before(Step end, Frame& frame) {
  if (end <= world.answered + 1) return;
  frame.unfinished.skipped = static_cast<std::uint64_t>(end - 1 - world.answered);
  broad.skip_to(world.clock.time(end));
  world.answered = end - 1;
}

// Runs the steps up to `last` that may have pairs. `end` is the last step of this call. Each step gets an equal share
// of the budget that is left.
void Detector::State::run_to(Step last, Step end, StepBudget& budget, Frame& frame) {
  const detail::Clock& clock = world.clock;
  while (world.answered < last && !reporter.full()) {
    // While there are pairs, which may part at any step, or bodies that are searched by parts, every step is run.
    // Otherwise, the broad phase may advance to its next pair, but not beyond the step at which a body may reach a
    // half-space, because it does not know half-spaces.
    const Step following = world.answered + 1;
    const bool under_way = !matcher.idle();
    const Step stop = std::min(last, under_way ? following : std::max(following, world.half_space_times.next()));
    StepsAhead next;
    broad.predict_load(clock.time(world.answered), {&next, 1});
    matcher.expect(static_cast<double>(next.meetings));
    StepBudget share = budget.share(static_cast<std::uint64_t>(end - world.answered));
    const Advance now = advance(stop, share);
    sampler.refuse(now.refused);
    frame.unfinished.incomplete_from = std::min(frame.unfinished.incomplete_from, now.incomplete_from);
    frame.unfinished.left_over += now.left_over;
    const bool found = !now.pairs.empty() || now.incomplete_from != kNoClass;
    const Step step = found ? std::llround((now.time - clock.start) / clock.time_step) : stop;
    if (found || under_way || world.half_space_times.next() <= step) answer(step, now, share, frame);
    interrupted = now.incomplete_from != kNoClass;
    budget.spend(share.spent());
    frame.cut = share.cut();
    world.answered = step;
  }
}

// Advances the broad phase up to a step, with at most half of the budget.
Advance Detector::State::advance(Step stop, StepBudget& share) {
  const double time = world.clock.time(stop);
  const std::uint64_t before = broad.motions_asked();
  Advance now{};
  if (!share.limited()) {
    if (stop == world.answered + 1) sampler.sample_all(stop);
    now = broad.advance(time);
  } else {
    Budget work;
    if (share.limited_in_work()) work.work = std::max<std::uint64_t>(1, share.left() / (2 * kMotionWork));
    if (share.timed()) work.time = load_model.time_for_broad(share.time_left(), matcher.cache().size());
    const double begun = share.clock();
    now = broad.advance(time, work, share.replay() != nullptr ? share.replay()->broad : 0);
    if (share.timed() && now.incomplete_from != kNoClass)
      load_model.learn_broad_excess(share.clock() - begun - static_cast<double>(work.time.count()));
    if (now.incomplete_from != kNoClass) share.cut_broad(now.work);
  }
  share.spend((broad.motions_asked() - before) * kMotionWork);
  return now;
}

}  // namespace orchard::runtime
