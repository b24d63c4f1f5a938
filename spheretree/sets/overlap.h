#pragma once
#include "orchard/spheretree/particles.h"

namespace orchard::detail {

// Returns the smallest distance between the centres of two balls, with radii a and b, at which they overlap by at most
// `share` of the smaller one.
double contact_distance(double a, double b, double share);

// Returns the largest radius, at most `limit`, such that all balls up to this radius are allowed. A ball is allowed if
// it overlaps another one by at most `share` of the smaller one; `distance` is the distance between their centres, and
// `other` the radius of the other one. Returns 0 if there is no such radius.
double allowed_radius(double distance, double other, double share, double limit);

}  // namespace orchard::detail
