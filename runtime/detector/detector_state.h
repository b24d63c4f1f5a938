#pragma once
#include "detector/match_pairs.h"
#include "detector/report_events.h"
#include "detector/schedule_pairs.h"
#include "detector/world_queries.h"

namespace orchard::runtime {

// The dissertation's Fig. 3.2: sample -> advance -> match -> schedule -> report. Each arrow but "advance", which is the
// broad phase, is a class of its own with a file of its own: StateSampler (sample_states.h), PairMatcher
// (match_pairs.h) with PartPairs (search_by_parts.h) and PairSkipper (skip_pairs.h), PairScheduler (schedule_pairs.h)
// with PairAnswerer (answer_pairs.h), EventReporter (report_events.h). This struct puts them together.
struct Detector::State {
  using Step = detail::Step;
  State(StateSource source, const DetectorOptions& wanted);
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // What `made()` gives. Where there is no memory for it, it is not known what has been done: nothing more is answered.
  template <typename Make>
  auto or_fail(Make&& made) {
    detail::UndoUnlessDone until_done([this] { failed = true; });
    auto result = made();
    until_done.done();
    return result;
  }
  bool contains(BodyId body) const noexcept { return !failed && world.contains(body); }

  // change_bodies.cpp: bodies come, change and go between two steps
  bool takes_changes() const noexcept { return valid && !failed && !stepping; }
  bool acceptable(std::span<const BodyPart> parts, const BodyOptions& options) const noexcept;
  detail::Body& add(BodyId id, std::span<const BodyPart> parts, const BodyOptions& with);
  bool set_asleep(BodyId id, bool asleep);
  bool place_static(detail::Body& body, const Pose& pose);  // false, and as it was: too large
  // What use(body) says. False if there is no such body, or none can be changed now.
  template <typename Use>
  bool change(BodyId id, Use&& use) {
    if (stepping || !contains(id)) return false;
    ++world.changes;
    return or_fail([&] { return use(world.body(id.index)); });
  }

  // detector_step.cpp: a step from its beginning to its end
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
  bool valid;                // the options are
  bool stepping = false;     // step() is under way, from within which the application's functions are called
  bool failed = false;       // out of memory
  bool interrupted = false;  // the broad phase, at the step before
  std::vector<std::uint32_t> open_pairs;  // of a step within a budget, to be asked about

 private:
  void rely_on_origins();  // change_bodies.cpp

  // detector_step.cpp
  void run_to(Step last, Step end, detail::StepBudget& budget, Frame& frame);
  Advance advance(Step stop, detail::StepBudget& share);
  void leave_out_before(Step end, Frame& frame);
  double next_time(bool steps_left) const noexcept;

  // answer_step.cpp: the pairs of a step, matched, answered and reported
  void answer(Step step, const Advance& now, detail::StepBudget& budget, Frame& frame);
  void answer_within(const detail::ActivePairs& active, Step step, double begun, detail::StepBudget& budget,
                     Frame& frame);  // `begun`: the budget's clock when the step's answers were
  void begin_pairs(const detail::ActivePairs& active, Step step);
};

}  // namespace orchard::runtime
