#pragma once
#include "detector/world.h"
#include "orchard/runtime/motion_monitor.h"

namespace orchard::runtime::detail {

// Sample: where bodies are at a step, and what the broad phase may rely on. Every question for a body's state is asked
// here, at most once a step.
class StateSampler {
 public:
  StateSampler(World& world, BroadPhase& broad, StateSource source);

  const StateSource& source() const noexcept { return source_; }
  void begin_call() noexcept { refused_.clear(), broken_.clear(); }
  // Makes the states of these bodies those of the step; a body may come up twice.
  void sample(Step step, std::span<const BodyIndex> bodies);
  // Where most bodies were in pairs at the step before: all of them at once, so that the broad phase's jobs may run at
  // once.
  void sample_all(Step step);
  // Whether every state is that of the step that the broad phase is at.
  bool sampled_all() const noexcept { return all_sampled_at_ == world_.answered + 1; }
  // The bodies of these pairs, in ascending order; refuses those whose states are not valid.
  void sample_pairs(Step step, std::span<const BodyPair> pairs);
  // What is relied on of a body whose state has been sampled: what its state says, or what the monitor makes of it.
  Motion given_motion(BodyIndex body, double time) const;
  // The broad phase asks for the motions of bodies.
  void answer_broad_phase(double time, std::span<const BodyIndex> asked, std::span<Motion> motions);

  bool watches() const noexcept { return watches_; }
  // Before the broad phase relies on anything at this step: compares every body's state with its motion bounds.
  void watch(Step step);
  void cancel(Body& body);  // its bounds do not hold any more
  void refuse(std::span<const BodyIndex> bodies) { refused_.insert(refused_.end(), bodies.begin(), bodies.end()); }
  MotionMonitor& monitor() noexcept { return monitor_; }
  void report(Frame& frame);  // what was refused, and whose bounds were broken, since begin_call()
  std::size_t memory_bytes() const noexcept {
    return monitor_.memory_bytes() + bytes_of(asking_, answers_, refused_, broken_, paired_, is_paired_);
  }

 private:
  void ask_for(BodyIndex body, Step step);
  void ask_all(Step step);
  void ask_source(Step step);
  void take_answer(Step step, BodyIndex index, const BodyState& answer) noexcept;
  bool keeps_motion_bound(BodyIndex index, Step step);
  bool keeps_more(const Body& body, Step step, const Motion& motion) const noexcept;

  World& world_;
  BroadPhase& broad_;
  StateSource source_;
  MotionMonitor monitor_;
  bool watches_;
  Step all_sampled_at_ = kNotAsked, paired_at_ = kNotAsked;
  std::atomic<bool> any_flawed_ = false;  // some answer was not valid; set by jobs
  std::vector<BodyIndex> asking_, refused_, broken_;
  std::vector<BodyState> answers_;
  std::vector<BodyIndex> paired_;        // of sample_pairs(), at the step paired_at_
  std::vector<std::uint8_t> is_paired_;  // by body, while `paired_` is made
};

}  // namespace orchard::runtime::detail
