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
  // with an unproven bound. Both are 0 if the code is right. The proof uses only the floats of the packed tree.
  Index balls_unproven = 0, bounds_unproven = 0;
};

// Packs ball_tree() of the balls, and proves that every point of the union of the balls lies in all packed balls of a
// path. So the answer "no" for two such trees is certain for their unions, at every level. Because there are no
// triangles, the answer for two leaves that meet is "maybe". Each leaf contains its ball, and is larger only by
// rounding to float. Throws Error as pack() does.
BallTree pack_balls(std::span<const Sphere> balls);

}  // namespace orchard
