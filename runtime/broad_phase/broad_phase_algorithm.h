#pragma once
#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

struct StepReport {
  Step next;                            // the next step with anything to do; > the one just processed
  std::span<const BodyPair> pairs{};    // that overlap, in ascending order; valid until the next call
  unsigned incomplete_from = kNoClass;  // as in Advance
  std::size_t left_over = 0;
};

enum class Near : std::uint8_t {
  untold,  // no way to tell: it may be any body
  some,    // others are farther away
  all      // there are no others
};

// All bodies that are met up to `until` have been visited by now. False: it is enough.
using VisitPortion = std::function<bool(std::span<const BodyIndex> bodies, double until)>;

// A way to find what happens next. Steps are processed in ascending order; those in between had nothing to do.
// Where step() throws, the method is not asked again. Where the others do, they have changed nothing.
class BroadPhaseAlgorithm {
 public:
  virtual ~BroadPhaseAlgorithm() = default;
  // The body is new or its bounds hold no longer; to be asked for at the next step that is processed.
  virtual void changed(BodyIndex body) = 0;
  // Called while the body pool still has it.
  virtual void removed(BodyIndex body) = 0;
  virtual void reclassified(BodyIndex body) = 0;  // the body pool has its new importance
  virtual StepReport step(Step now, BudgetTracker& tracker) = 0;
  // Steps are left out before the next one; every body has been changed().
  virtual void skip() noexcept {}
  virtual std::size_t memory_bytes() const noexcept = 0;
  // Adds what is due at the steps after `now`, one after the other; returns for how many it knows.
  virtual std::size_t predict_load(Step now, std::span<StepsAhead> steps) const noexcept {
    (void)now, (void)steps;
    return 0;
  }

  // For queries about `now`: the last step that was processed, or one after it before anything is due. What they hand
  // over may be far away, gone, or come up twice. Appends all bodies whose spheres may meet the box.
  virtual Near near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const {
    (void)now, (void)lower, (void)upper, (void)bodies;
    return Near::untold;
  }
  // Visits all bodies whose spheres origin + t way may meet, |way| = 1 and 0 <= t <= length. `portion` is for its use.
  // False: it may be any body, and no body has been visited.
  virtual bool along(Step now, const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
                     const VisitPortion& visit) const {
    (void)now, (void)origin, (void)way, (void)length, (void)portion, (void)visit;
    return false;
  }
  virtual double cell_size() const noexcept { return 0; }  // a length to begin a search with; 0: none
};

std::unique_ptr<BroadPhaseAlgorithm> make_kinetic_broad_phase(BodyPool& pool, const BroadPhaseOptions& options);

// The seam for code that finds what happens next in another way (declared in broad_phase.h, for the friendship):
//   BroadPhase make_broad_phase(MotionSource source, const BroadPhaseOptions& options, const MakeMethod& make);
// `make` is called once, before it returns, with options that are valid; the body pool stays where it is. This
// header is not installed: such code is built together with the run-time, as bench/thesis/broad_phase_methods is.

}  // namespace orchard::runtime::detail
