#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "orchard/runtime/collide.h"

// When two moving bodies first touch. The result is certified, so that no body passes through another, however thin or
// fast it is.
namespace orchard::runtime {

// The motion of a body: its pose at time 0 and how it changes. `center`, a point in the body's own coordinates, moves
// straight at `velocity`; about it the body turns at the constant angular velocity `spin` (axis times radians per unit
// of time, in the world). A screw is such a motion, with the centre on its axis.
// With `pose_at` the motion may be any. The function returns the pose at a time, with the scale of `start`, which must
// be its value at 0. Between two times s < t, the centre must move by at most speed (t - s) and the body must turn by
// at most the angle turning (t - s). It is called from the calling thread and must not throw.
struct Travel {
  Pose start;
  std::array<double, 3> velocity{}, spin{}, center{};
  Pose (*pose_at)(const void* context, double time) = nullptr;
  const void* context = nullptr;
  double speed = 0, turning = 0;  // For pose_at only.

  Pose at(double time) const noexcept;
};

// Returns the motion from one pose to another in one unit of time: `center` moves straight, and the rotation is about
// one axis by the smallest angle. Precondition: is_rigid() of both, and the same scale.
Travel travel_between(const Pose& from, const Pose& to, const std::array<double, 3>& center = {}) noexcept;

// The options of time_of_impact().
struct ImpactOptions {
  // The times of the search. With the t0 of an earlier result as `begin`, a query continues where that one stopped.
  double begin = 0, end = 1;
  // The search ends if the surfaces are this close (or this close to `margin`), in world units. The effective value is
  // at least about 1e-9 of the bodies' size, and at least the rounding.
  double tolerance = 1e-4;
  // The distance that counts as touching, in world units: a sphere or capsule is a point or segment with its radius as
  // margin.
  double margin = 0;
  Budget budget = {};
};

// The result of time_of_impact().
struct Impact {
  // no: the surfaces do not touch (are farther apart than `margin`) at any time from begin to end; this is certain.
  // yes: they do not touch before t0, and they do at t1.
  // maybe: they do not touch before t0, and at t0 they are `distance` apart; later contacts are unknown. This distance
  // is less than margin + tolerance, which is a contact for all practical purposes, unless the budget ended the search.
  Answer answer = Answer::maybe;
  double t0 = 0;                                        // Certified: no contact in [begin, t0).
  double t1 = std::numeric_limits<double>::infinity();  // Certified: contact at t1; infinite if none was found.
  // An upper bound on the surfaces' distance at t0, if known.
  double distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> on_a{}, on_b{};  // The places at t0 in the world, if the distance is finite.
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  std::uint32_t steps = 0;  // The number of steps in which the time advanced.
  bool finished = false;    // False: the budget ended the search.
  bool refused = false;     // As NarrowPhase::refused(); t0 is then `begin`.
  std::uint64_t work = 0;   // In units of a budget.
};

// Finds the first contact by conservative advancement. At each time, every pair of nodes and of triangles that
// could meet next is followed along the direction in which it is apart. The speed at which this gap can close, which
// includes the turning of each body about its centre, gives a time before which it cannot be closed; the least such
// time is the next one. A step costs about as much as a distance query, and a few steps suffice unless the bodies graze
// each other.
Impact time_of_impact(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b,
                      const ImpactOptions& options = {}) noexcept;

}  // namespace orchard::runtime
