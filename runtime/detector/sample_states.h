#pragma once
#include "detector/world.h"
#include "orchard/runtime/motion_monitor.h"

namespace orchard::runtime::detail {

// The stage "sample" of a step: asks the source for the states of bodies, at most once per step for each body, and
// derives the motion bounds on which the broad phase relies.
class StateSampler {
 public:
  StateSampler(World& world, BroadPhase& broad, StateSource source);

  const StateSource& source() const noexcept { return source_; }
  void begin_call() noexcept { refused_.clear(), broken_.clear(); }
  // Asks for the states of these bodies at the step, unless they are known. A body may occur twice.
  void sample(Step step, std::span<const BodyIndex> bodies);
  // Asks for the states of all bodies if at least half of them, and at least 256, were in pairs at the step before. The
  // jobs of the broad phase may then run at the same time, because they need not ask.
  void sample_all(Step step);
  // Returns whether sample_all() has asked for the states of the step that the broad phase is at.
  bool sampled_all() const noexcept { return all_sampled_at_ == world_.answered + 1; }
  // Samples the bodies of these pairs, and refuses those whose states are not valid. The pairs are in ascending order.
  void sample_pairs(Step step, std::span<const BodyPair> pairs);
  // Returns the motion bound of a body whose state has been sampled: that of the state or, if BodyOptions::suggest is
  // set, the one that the monitor suggests.
  Motion given_motion(BodyIndex body, double time) const;
  // Fills in motions[i] of the body asked[i]. It is the source of the broad phase.
  void answer_broad_phase(double time, std::span<const BodyIndex> asked, std::span<Motion> motions);

  bool watches() const noexcept { return watches_; }
  // Compares the state of every moving body with its motion bound, and cancels those that do not hold. Call it before
  // the broad phase advances to the step.
  void watch(Step step);
  void cancel(Body& body);  // its motion bound does not hold any more
  void refuse(std::span<const BodyIndex> bodies) { refused_.insert(refused_.end(), bodies.begin(), bodies.end()); }
  MotionMonitor& monitor() noexcept { return monitor_; }
  void report(Frame& frame);  // sets Frame::refused and Frame::broken, for the bodies since begin_call()
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
  std::atomic<bool> any_flawed_ = false;  // an answer of the source was not valid; set by jobs
  std::vector<BodyIndex> asking_, refused_, broken_;
  std::vector<BodyState> answers_;
  std::vector<BodyIndex> paired_;        // the bodies that were in pairs at the step paired_at_
  std::vector<std::uint8_t> is_paired_;  // by body: scratch for finding `paired_`, otherwise 0
};

}  // namespace orchard::runtime::detail
