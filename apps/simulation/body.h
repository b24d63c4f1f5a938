#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/motion.h"
#include "orchard/runtime/pose.h"

// Rigid bodies as the simulator moves them: the simplest dynamics that bring bodies together, none of it for its own
// sake.
namespace orchard::simulation {

using runtime::Motion;
using runtime::Pose;
using runtime::Vec3;

using Quaternion = std::array<double, 4>;  // w x y z

Vec3 cross(const Vec3& a, const Vec3& b);
Vec3 unit(const Vec3& v);  // zero stays zero
Vec3 turned(const Quaternion& q, const Vec3& v);
Quaternion product(const Quaternion& a, const Quaternion& b);
Quaternion normalized(const Quaternion& q);
Quaternion about(const Vec3& axis, double angle);  // the axis of length 1

struct Body {
  std::uint32_t shape = 0;
  double scale = 1;
  double radius = 1;      // of the bounding sphere, around `position`
  bool scripted = false;  // its scene sets position and velocity; forces do nothing
  bool fixed = false;     // never moves
  bool there = true;
  double mass = 1, inertia = 1;  // the inertia of a ball

  Vec3 position{}, velocity{}, spin{};
  Quaternion attitude{1, 0, 0, 0};
  Vec3 force{}, torque{};  // of this step

  Vec3 home{};                     // flight: where drones jump to
  double throttle = 0;             // flight: -1 .. 1
  std::array<double, 2> rudder{};  // flight: yaw and pitch, -1 .. 1
  double next_control = 0;         // flight: when new ones are drawn

  double acceleration = 0;  // M, as promised
  double drift = 0;
  Vec3 half_space{};
  double expiry = 1e300;
};

// Semi-implicit Euler with everything that acts on a body; the acceleration is cut to `max_acceleration`.
void integrate(Body& body, double dt, double max_acceleration);

}  // namespace orchard::simulation
