#pragma once
#include <limits>
#include <string>
#include <vector>

#include "orchard/covering/boundary_lemma.h"
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

// The data structure of a sphere-tree while it is built and measured.
namespace orchard {

// A node of a sphere-tree.
struct SphereNode {
  Sphere sphere;
  Index parent = kNone;
  // The children are contiguous and come after their parent.
  Index first_child = kNone;
  Index child_count = 0;  // 0 for a leaf.
  Index level = 0;        // 0 for the root.

  // The signed distance of the centre to the surface, negative inside, in mesh units. measure() fills this value and
  // the two below. They are infinite until then, so that a tree that is packed without them guarantees no distances.
  double center_distance = kUnknown;
  // An upper bound on the distance to the solid from any point of the ball, in mesh units.
  double distance_bound = kUnknown;
  // An upper bound on Hubbard's inaccuracy, within tolerance::kInaccuracy * R of it, in mesh units.
  double inaccuracy = kUnknown;

  // The value of a quantity that was not measured.
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
};

// A sphere-tree: nodes in breadth-first order, the root first. A tree is conservative by the path rule if every point
// of the surface lies in all balls of at least one path from the root to a leaf.
struct SphereTree {
  std::vector<SphereNode> nodes;
  Index branching = 8;  // The largest number of children of a node.
  Index depth() const { return nodes.empty() ? 0 : nodes.back().level; }
};

// Checks the structure of a tree. Throws Error unless there is one root, the order is breadth-first, children are
// contiguous, and radii are positive and finite.
void validate(const SphereTree& tree);

// Returns the balls of a tree in the form that the boundary lemma uses, in the order of the nodes.
std::vector<PathBall> path_balls(const SphereTree& tree);
// Returns balls that are all leaves in that form, relative to `origin`.
std::vector<PathBall> path_balls(std::span<const Sphere> balls, const Point& origin);

// The number of spheres of a level, and their inaccuracies as fractions of the bounding radius.
struct LevelFigures {
  Index spheres = 0;
  double mean_inaccuracy = 0, max_inaccuracy = 0;
};
// Returns one row for each level, the root's first. Precondition: measure() has filled the nodes.
std::vector<LevelFigures> level_figures(const SphereTree& tree, double bounding_radius);

// Returns one number for how loosely a tree fits, in mesh units: the geometric mean of the mean and maximum
// inaccuracies of all levels below the root, or 0 if there are none. Use it to choose between trees with the same
// number of levels: the same relative change of any of these values changes the result equally. Precondition: measure()
// has filled the nodes.
double overall_inaccuracy(const SphereTree& tree);

}  // namespace orchard
