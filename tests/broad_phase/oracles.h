#pragma once
#include "orchard/broad_phase_methods/space_time_bound.h"
#include "orchard/runtime/broad_phase.h"

namespace orchard::runtime::test {

using broad_phase_methods::SpaceTimeBound;

// The least t in [0, duration] at which the hypertrapezoids, cut by their planes, have a common point: the linear
// program in (x, y, z, t), by trying every vertex of its feasible region.
double min_time(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration);

// The pairs of spheres that touch, in ascending order, from positions alone: every sphere is compared with those that
// begin before it ends along x.
std::vector<BodyPair> touching_pairs(std::span<const Motion> motions);

}  // namespace orchard::runtime::test
