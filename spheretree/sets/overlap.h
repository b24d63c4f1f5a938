#pragma once
#include "orchard/spheretree/particles.h"

namespace orchard::detail {

// The least distance of the centres at which two balls overlap by no more than `share` of the smaller one.
double contact_distance(double a, double b, double share);

// The largest radius, at most `limit`, of a ball with its centre `distance` away from that of another ball, so that
// they overlap by no more than `share` of the smaller one. 0 where there is none, also where only a ball that is larger
// than some that are not allowed would do.
double allowed_radius(double distance, double other, double share, double limit);

}  // namespace orchard::detail
