#pragma once
#include <span>

#include "robot/link_shape.h"

namespace orchard::robot {

inline constexpr double kUsualDensity = 1000;  // kg / m^3

// Whether it is that of some distribution of mass: a mass above 0, principal moments above 0, none of which exceeds the
// sum of the others.
bool is_body(const Inertial& inertial);

// A link as a rigid body, in its frame: what the URDF says, if that is_body(); otherwise the solid of that density;
// where there is no solid, the spheres, each of that density. `shape`: of the link, or nullptr.
Inertial body_of(const Link& link, const LinkShape* shape, std::span<const Sphere> spheres,
                 double density = kUsualDensity);

}  // namespace orchard::robot
