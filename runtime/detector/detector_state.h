#pragma once
#include "detector/match_pairs.h"
#include "detector/report_events.h"
#include "detector/schedule_pairs.h"
#include "detector/world_queries.h"

namespace orchard::runtime {

// The detector of the dissertation's Fig. 3.2. A step has five stages, and this struct puts them together. Each stage
// except "advance" is a class in a file of its own:
//   1. sample: StateSampler (sample_states.h);
//   2. advance: the broad phase;
//   3. match: PairMatcher (match_pairs.h) with PartPairs (search_by_parts.h) and PairSkipper (skip_pairs.h);
//   4. schedule: PairScheduler (schedule_pairs.h) with PairAnswerer (answer_pairs.h);
//   5. report: EventReporter (report_events.h).
struct Detector::State {
  using Step = detail::Step;
  State(StateSource source, const DetectorOptions& wanted);
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // Returns made(). If it throws, because memory has run out, it is not known which changes were made. The detector
  // then sets `failed` and answers nothing more.
  template <typename Make>
  auto or_fail(Make&& made) {
    detail::UndoUnlessDone until_done([this] { failed = true; });
    auto result = made();
    until_done.done();
    return result;
  }
  bool contains(BodyId body) const noexcept { return !failed && world.contains(body); }

  // In change_bodies.cpp: the application adds, changes and removes bodies between two steps.
  bool takes_changes() const noexcept { return valid && !failed && !stepping; }
  bool acceptable(std::span<const BodyPart> parts, const BodyOptions& options) const noexcept;
  detail::Body& add(BodyId id, std::span<const BodyPart> parts, const BodyOptions& with);
  bool set_asleep(BodyId id, bool asleep);
  bool place_static(detail::Body& body, const Pose& pose);  // returns false and changes nothing if it is too large
  // Returns use(body), or false if there is no such body or a step is running.
  template <typename Use>
  bool change(BodyId id, Use&& use) {
    if (stepping || !contains(id)) return false;
    ++world.changes;
    return or_fail([&] { return use(world.body(id.index)); });
  }

  // In detector_step.cpp: a call of step() from its beginning to its end.
  void run(double time, const Budget& budget, const StepOptions& with, Frame& frame);

  Manifold manifold(const PairEvent& event, const ContactOptions& with) noexcept;  // manifold.cpp

  detail::World world;
  BroadPhase broad;
  detail::StateSampler sampler;
  detail::PartPairs part_pairs;
  detail::PairMatcher matcher;
  detail::PairSkipper skipper;
  detail::PairScheduler scheduler;
  detail::EventReporter reporter;
  detail::LoadModel load_model;
  detail::WorldQueries queries;
  bool valid;                // the options are valid
  bool stepping = false;     // step() is running; functions of the application that it calls can change nothing
  bool failed = false;       // memory has run out
  bool interrupted = false;  // the broad phase was interrupted at the step before
  std::vector<std::uint32_t> open_pairs;  // within a budget: the records of the pairs that the step has to answer

 private:
  void rely_on_origins();  // in change_bodies.cpp: gives up the middles of all bodies, for the first continuous body

  // In detector_step.cpp.
  void run_to(Step last, Step end, detail::StepBudget& budget, Frame& frame);
  Advance advance(Step stop, detail::StepBudget& share);
  void leave_out_before(Step end, Frame& frame);
  double next_time(bool steps_left) const noexcept;

  // In answer_step.cpp: the pairs of a step are matched, answered and reported.
  void answer(Step step, const Advance& now, detail::StepBudget& budget, Frame& frame);
  // `begun` is the time of the budget's clock when answer() began.
  void answer_within(const detail::ActivePairs& active, Step step, double begun, detail::StepBudget& budget,
                     Frame& frame);
  void begin_pairs(const detail::ActivePairs& active, Step step);
};

}  // namespace orchard::runtime
