#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/mesh.h"

// Solids extruded along z from the outlines of the dissertation's figures on gap-crossing cells (6.2.4).
namespace orchard::test {

using Outline = std::vector<std::array<double, 2>>;  // counter-clockwise, simple

TriangleMesh extruded(const Outline& outline, double height);

Outline thin_bridge(double thickness);  // 6.14: two blocks joined by a bridge thinner than the points' spacing
Outline knees(double gap);              // 6.15: two legs whose knees bend towards each other
Outline short_shelf(double gap);        // 6.18: a long side faces a short one across a gap
Outline two_teeth(double gap);          // 6.19: a ceiling that two teeth come near, with nothing between them
Outline v_groove(double width);         // 6.21: a deep V cut into a block
Outline u_groove(double width);         // 6.22: a U with a bottom that small

}  // namespace orchard::test
