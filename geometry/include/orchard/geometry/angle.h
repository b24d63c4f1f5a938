#pragma once
#include <cmath>

#include "orchard/geometry/mesh.h"

namespace orchard {

// The angle between two vectors, in radians from 0 to pi, to a few roundings however small it is; 0 if one is zero.
inline double angle_between(const Vector& a, const Vector& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace orchard
