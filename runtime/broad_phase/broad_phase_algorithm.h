#pragma once
#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

// The result of BroadPhaseAlgorithm::step().
struct StepReport {
  Step next;                            // the next step with anything to do, after the one just processed
  std::span<const BodyPair> pairs{};    // the pairs that overlap, in ascending order; valid until the next call
  unsigned incomplete_from = kNoClass;  // as in Advance
  std::size_t left_over = 0;
};

// What a query by box has found.
enum class Near : std::uint8_t {
  untold,  // nothing: any body may meet the box
  some,    // candidates; other bodies are farther away
  all      // all bodies
};

// Receives the next bodies on the way of a ray. All bodies that the ray meets up to the length `until` are in this
// portion or in earlier ones. Returns false to end the search.
using VisitPortion = std::function<bool(std::span<const BodyIndex> bodies, double until)>;

// An algorithm that finds the pairs of each step, and the next step with anything to do. Steps are processed in
// ascending order; those that are left out had nothing to do. If step() throws, no function is called any more. If
// another function throws, it has changed nothing.
class BroadPhaseAlgorithm {
 public:
  virtual ~BroadPhaseAlgorithm() = default;
  // The body is new, or its bounds do not hold any more. The next step that is processed has to ask for its motion.
  virtual void changed(BodyIndex body) = 0;
  // The body is about to be removed from the body pool.
  virtual void removed(BodyIndex body) = 0;
  // The body has another importance, which the body pool has already.
  virtual void reclassified(BodyIndex body) = 0;
  // Processes a step.
  virtual StepReport step(Step now, BudgetTracker& tracker) = 0;
  // Steps before the next one are skipped. changed() has been called for every body.
  virtual void skip() noexcept {}
  virtual std::size_t memory_bytes() const noexcept = 0;
  // Adds to steps[i] what is due at the step now + 1 + i. Returns for how many steps this is known.
  virtual std::size_t predict_load(Step now, std::span<StepsAhead> steps) const noexcept {
    (void)now, (void)steps;
    return 0;
  }

  // The next two functions find candidates for queries about `now`: the last step that was processed, or a later one
  // before anything is due. The candidates may include bodies that are far away or gone, and a body may occur twice.
  // Appends all bodies whose spheres may meet the box.
  virtual Near near_box(Step now, const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const {
    (void)now, (void)lower, (void)upper, (void)bodies;
    return Near::untold;
  }
  // Visits all bodies whose spheres origin + t way may meet, with |way| = 1 and 0 <= t <= length. `portion` is scratch.
  // Returns false if it may be any body; then no body has been visited.
  virtual bool along(Step now, const Vec3& origin, const Vec3& way, double length, std::vector<BodyIndex>& portion,
                     const VisitPortion& visit) const {
    (void)now, (void)origin, (void)way, (void)length, (void)portion, (void)visit;
    return false;
  }
  virtual double cell_size() const noexcept { return 0; }  // a length with which a search may begin; 0 if there is none
};

std::unique_ptr<BroadPhaseAlgorithm> make_kinetic_broad_phase(BodyPool& pool, const BroadPhaseOptions& options);

// Code outside of the run-time can provide an algorithm of its own by this function. It is declared in broad_phase.h,
// because it is a friend of BroadPhase:
//   BroadPhase make_broad_phase(MotionSource source, const BroadPhaseOptions& options, const MakeMethod& make);
// It calls `make` once, with valid options; the body pool does not move in memory afterwards. This header is not
// installed, so such code is built together with the run-time, as bench/thesis/broad_phase_methods is.

}  // namespace orchard::runtime::detail
