#pragma once
#include "roster.h"

namespace orchard::runtime::detail {

struct StepReport {
  Step next;                            // the next step with anything to do; > the one just processed
  unsigned incomplete_from = kNoClass;  // as in Advance
  std::size_t left_over = 0;
};

// A way to find what happens next. Steps are processed in ascending order; those in between had nothing to do.
// Where step() throws, the method is not asked again. Where the others do, they have changed nothing.
class Method {
 public:
  virtual ~Method() = default;
  // The body is new or its bounds hold no longer; to be asked for at the next step that is processed.
  virtual void changed(BodyIndex body) = 0;
  // Called while the roster still has it.
  virtual void removed(BodyIndex body) noexcept = 0;
  virtual void reclassified(BodyIndex body) = 0;  // the roster has its new importance
  // Puts the overlapping pairs into `pairs`, in ascending order.
  virtual StepReport step(Step now, Meter& meter, std::vector<BodyPair>& pairs) = 0;
  virtual std::size_t memory_bytes() const noexcept = 0;
  // Adds what is due at the steps after `now`, one after the other; returns for how many it knows.
  virtual std::size_t foresee(Step now, std::span<StepsAhead> steps) const noexcept {
    (void)now, (void)steps;
    return 0;
  }
};

std::unique_ptr<Method> make_events(Roster& roster, const BroadPhaseOptions& options);

// The seam for a library that finds what happens next in another way (declared in broad_phase.h, for the friendship):
//   BroadPhase make_broad_phase(MotionSource source, const BroadPhaseOptions& options, const MakeMethod& make);
// `make` is called once, before it returns, with options that are valid; the roster stays where it is. As this header
// is not installed, such a library is built together with this one.

}  // namespace orchard::runtime::detail
