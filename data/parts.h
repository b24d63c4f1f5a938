// Parts that more than one model uses.
#pragma once

#include <vector>

#include "solid_builder.h"

namespace orchard::models {

/// One ring of a turned part: how far along the axis, and the scale of the section there.
struct Ring {
  double height = 0.0;
  double scale = 1.0;
};

/// Grows copies of `section` along the normal of `frame`; heights count from its origin. Two rings
/// of equal height make a flat step. Returns the last loop, still open.
Loop grow_rings(SolidBuilder& solid, Loop from, const Frame& frame, const Section& section,
                const std::vector<Ring>& rings);

/// Ends a loop drawn as `section`, a regular polygon with corners at distance `neck` from the
/// frame's origin, with a ball of the given radius that the loop cuts open.
void grow_ball(SolidBuilder& solid, const Loop& from, const Frame& frame, const Section& section, double neck,
               double radius, int bands);

}  // namespace orchard::models
