#pragma once
#include "space_time_bound.h"

namespace orchard::broad_phase_methods {

// The least t in [0, duration] at which the hypertrapezoids, cut by their planes, have a common point: the linear
// program in (x, y, z, t), by trying every vertex of its feasible region.
double min_time(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration);

}  // namespace orchard::broad_phase_methods
