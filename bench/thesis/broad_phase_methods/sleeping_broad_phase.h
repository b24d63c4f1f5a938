#pragma once
#include <cstdint>

#include "orchard/runtime/broad_phase.h"

namespace orchard::broad_phase_methods {

using runtime::BroadPhase;
using runtime::BroadPhaseOptions;
using runtime::MotionSource;

// How the earliest contact of two bounds is found. All give the same pairs at the same steps, which are those of a
// BroadPhase that is made by its constructor, too; they differ in speed.
enum class SleepingMethod : std::uint8_t {
  all_pairs,    // by comparing all pairs of hypertrapezoids
  projection,   // by projecting faces and sweeping (dissertation 4.2.3)
  subdivision,  // by 16-way cells in space and time (4.2.4)
  hybrid,       // by a few cells, projection in each (8.2)
  quadratic,    // by projection of a cube around every cross section (8.2)
  horns         // by the parabolic horns themselves (8.2)
};

// Which bounds are asked for again on waking (4.3).
enum class Rebuild : std::uint8_t { what_intersected, everything };

struct SleepingOptions {
  SleepingMethod method = SleepingMethod::projection;
  Rebuild rebuild = Rebuild::what_intersected;
  BroadPhaseOptions common{};  // `window` has no meaning here
};

// The dissertation's broad phase (Fig. 4.23): it sleeps until the earliest two bounds touch, asks for new ones, and
// looks again; while bounds touch, at every step. Two bodies close to each other keep all others awake: for large
// worlds the constructor of BroadPhase is the one to take. What BroadPhase promises holds, and its members do as they
// say there; a budget interrupts the asking for motions, not the search. Throws std::bad_alloc, as the constructor
// does.
BroadPhase make_sleeping_broad_phase(MotionSource source, const SleepingOptions& options = {});

}  // namespace orchard::broad_phase_methods
