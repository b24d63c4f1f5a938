#pragma once
#include <span>

#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/tree.h"

// Builds sphere-trees over any set of balls, without a mesh.
namespace orchard {

// Builds a tree whose leaves are the balls and whose other nodes contain the balls below them. Balls near each other
// share parents, and all leaves are on the last level or on the one above. Precondition: there is at least one ball,
// and all balls are finite with radii above 0. The result is deterministic. O(n log n).
SphereTree ball_tree(std::span<const Sphere> balls, Index branching = 8);

// A tree for the run-time whose object is a union of balls, without any triangle.
struct BallTree {
  runtime::PackedSphereTree packed;
  // The number of balls that are not proven to lie in all packed balls of a path to a leaf, and the number of nodes
  // with an unproven bound. Both are 0, unless an assumption about roundings is wrong. They are decided on the packed
  // floats alone.
  Index balls_unproven = 0, bounds_unproven = 0;
};

// Packs ball_tree() of the balls and proves it. Every point of the union lies in all balls of a path, so that "no" is
// certain for the unions of two such trees at every level. There are no triangles, so the last answer is "maybe", which
// is given where two leaves meet. Each leaf contains its ball and is larger by roundings to float alone. Throws Error
// as pack() does.
BallTree pack_balls(std::span<const Sphere> balls);

}  // namespace orchard
