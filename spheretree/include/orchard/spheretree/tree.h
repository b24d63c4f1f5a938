#pragma once
#include <limits>
#include <string>
#include <vector>

#include "orchard/covering/boundary_lemma.h"
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard {

struct SphereNode {
  Sphere sphere;
  Index parent = kNone;
  Index first_child = kNone;  // children are contiguous and come after their parent
  Index child_count = 0;      // 0: a leaf
  Index level = 0;            // 0: the root

  // Filled by measure(); lengths in mesh units. Infinite while unknown, so that what is packed without them promises
  // nothing about how far anything is.
  double center_distance = kUnknown;  // signed distance of the centre to the surface, negative inside
  double distance_bound = kUnknown;   // upper bound on the distance to the solid from any point of the ball
  double inaccuracy = kUnknown;       // Hubbard's: upper bound, within tolerance::kInaccuracy * R

  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
};

// A sphere-tree: nodes in breadth-first order, the root first. A tree is conservative by the path rule if every point
// of the surface lies in all balls of at least one path from the root to a leaf.
struct SphereTree {
  std::vector<SphereNode> nodes;
  Index branching = 8;  // no node has more children
  Index depth() const { return nodes.empty() ? 0 : nodes.back().level; }
};

// Checks a tree's structure. Throws Error unless there is one root, the order is breadth-first, children are
// contiguous, and radii are positive and finite.
void validate(const SphereTree& tree);

// The balls of a tree as the boundary lemma takes them, in the order of the nodes.
std::vector<PathBall> path_balls(const SphereTree& tree);
// The same of balls that are all leaves, relative to `origin`.
std::vector<PathBall> path_balls(std::span<const Sphere> balls, const Point& origin);

// How many spheres a level has, and their inaccuracies as fractions of the bounding radius.
struct LevelFigures {
  Index spheres = 0;
  double mean_inaccuracy = 0, max_inaccuracy = 0;
};
// One row for each level, the root's first. Precondition: measure() has filled the nodes.
std::vector<LevelFigures> level_figures(const SphereTree& tree, double bounding_radius);

// One number for how loosely a tree fits, in mesh units: the geometric mean of the mean and the maximum inaccuracy of
// all levels below the root, 0 if there are none. What trees of as many levels are compared by where one is to be kept:
// a part of any figure weighs as much as the same part of any other. Precondition: measure() has filled the nodes.
double overall_inaccuracy(const SphereTree& tree);

}  // namespace orchard
