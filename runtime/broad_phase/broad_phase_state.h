#pragma once
#include "broad_phase/broad_phase_algorithm.h"

namespace orchard::runtime {

struct BroadPhase::State {
  State(MotionSource source, const detail::Clock& clock) : pool(std::move(source), clock) {}

  detail::BodyPool pool;
  std::unique_ptr<detail::BroadPhaseAlgorithm> method;
  detail::Step next = detail::kNeverStep;  // the next step with anything to do
  detail::Step validated = -1;             // the last step at which all bodies were asked for, to check their bounds
  bool woken = false;                      // a change since the last step requires another one
  bool busy = false;                       // a source, a filter or a listener may be running
};

// Marks, while an object of it exists, that functions of the application may run, within which changes are refused: see
// MotionSource.
class BroadPhase::Busy {
 public:
  explicit Busy(State& state) noexcept : state_(state) { state_.busy = true; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;
  ~Busy() { state_.busy = false; }

 private:
  State& state_;
};

}  // namespace orchard::runtime
