#pragma once
#include <span>

#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/tree.h"

// Sphere-trees over any set of balls.
namespace orchard {

// A tree whose leaves are the balls and whose other nodes each hold the balls below them: balls near each other share
// parents, and all leaves are on the last level or the one above. Precondition: there is a ball, and all are finite
// with radii above 0. Deterministic; O(n log n).
SphereTree ball_tree(std::span<const Sphere> balls, Index branching = 8);

// A tree for the run-time whose object is the union of balls, without any triangle.
struct BallTree {
  runtime::PackedSphereTree packed;
  // How many balls are not proven to lie in all packed balls of a path to a leaf, and how many nodes have a bound that
  // is not: 0, unless an assumption about roundings is wrong. Both are decided on the packed floats alone.
  Index balls_unproven = 0, bounds_unproven = 0;
};

// Packs ball_tree() of the balls and proves it. Every point of the union lies in all balls of a path, so that "no" is
// certain for the unions of two such trees at every level. There are no triangles, so that "maybe" is the last answer,
// given where two leaves meet: each holds its ball and is larger by roundings to float alone. Throws Error as pack()
// does.
BallTree pack_balls(std::span<const Sphere> balls);

}  // namespace orchard
