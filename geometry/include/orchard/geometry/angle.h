#pragma once
#include <cmath>

#include "orchard/geometry/mesh.h"

// The angle between two vectors.
namespace orchard {

// Returns the angle between two vectors in radians, from 0 to pi. It is accurate to a few roundings for angles of any
// size, and 0 if one vector is zero.
inline double angle_between(const Vector& a, const Vector& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace orchard
