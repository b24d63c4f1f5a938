#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "orchard/runtime/collide.h"

// When two moving bodies touch first: certified, so that nothing tunnels however thin or fast it is.
namespace orchard::runtime {

// How a body moves while time goes by: its pose at time 0 and what changes it. `center`, a point of the body in its own
// coordinates, moves straight at `velocity`; about it the body turns at the constant angular velocity `spin` (axis
// times radians per unit of time, in the world). A screw is such a motion, with the centre on its axis.
// With `pose_at` the motion may be any: then it gives the pose at a time, with the scale of `start`, which must be its
// value at 0; no more is asked of it than that between two times s < t the centre moves at most speed (t - s) and the
// body turns at most by the angle turning (t - s). It is called from the calling thread and throws nothing.
struct Travel {
  Pose start;
  std::array<double, 3> velocity{}, spin{}, center{};
  Pose (*pose_at)(const void* context, double time) = nullptr;
  const void* context = nullptr;
  double speed = 0, turning = 0;  // for pose_at only

  Pose at(double time) const noexcept;
};

// The motion from one pose to another in one unit of time: `center` straight, the rotation about one axis by the
// smallest angle. Precondition: is_rigid() of both, the same scale.
Travel travel_between(const Pose& from, const Pose& to, const std::array<double, 3>& center = {}) noexcept;

struct ImpactOptions {
  double begin = 0, end = 1;  // times; with an earlier result's t0 as `begin` a query goes on where it stopped
  // The search ends where the surfaces are so close to each other, in world units (or to `margin`): at least about
  // 1e-9 of the bodies' size, and never less than rounding.
  double tolerance = 1e-4;
  double margin = 0;  // touching is being so close: a sphere or capsule is a point or segment with its radius as margin
  Budget budget = {};
};

struct Impact {
  // no: the surfaces do not touch (are farther apart than `margin`) at any time from begin to end: certain.
  // yes: they do not before t0, and they do at t1. maybe: not before t0; at t0 they are `distance` apart, and what
  // follows is not known: less than margin + tolerance (a contact to all intents) unless the budget ended the search.
  Answer answer = Answer::maybe;
  double t0 = 0;                                              // certified: no contact in [begin, t0)
  double t1 = std::numeric_limits<double>::infinity();        // certified: contact at t1; infinite if none was found
  double distance = std::numeric_limits<double>::infinity();  // upper bound on the surfaces' distance at t0, if known
  std::array<double, 3> on_a{}, on_b{};                       // where, at t0, in the world; if distance is finite
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  std::uint32_t steps = 0;  // that the time was advanced in
  bool finished = false;    // false: the budget ended the search
  bool refused = false;     // as NarrowPhase::refused(): t0 is then `begin`
  std::uint64_t work = 0;   // as a budget counts it
};

// By conservative advancement: at a time every pair of ball slabs, and of triangles, that could meet next is followed
// along the direction in which it is apart; how fast that gap can close, the turning of each about its centre included,
// says until when it surely does not; the least such time is the next one. A step costs about as much as a distance
// query, and a few are enough unless the bodies graze each other.
Impact time_of_impact(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b,
                      const ImpactOptions& options = {}) noexcept;

}  // namespace orchard::runtime
