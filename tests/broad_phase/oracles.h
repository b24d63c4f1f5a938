#pragma once
#include "orchard/runtime/broad_phase.h"

namespace orchard::runtime::test {

// The pairs of spheres that touch, in ascending order, from positions alone: every sphere is compared with those that
// begin before it ends along x.
std::vector<BodyPair> touching_pairs(std::span<const Motion> motions);

}  // namespace orchard::runtime::test
