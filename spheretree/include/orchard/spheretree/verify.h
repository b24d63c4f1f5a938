#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/covering/uncovered_part.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"

// Verifies a packed sphere-tree from its floats and the mesh alone.
namespace orchard {

// A guarantee of a packed tree that verify() could not prove.
struct Violation {
  enum class Kind : std::uint8_t {
    uncovered,        // A point of a triangle that no path region is certain to contain.
    unlisted,         // The triangle has its paths, but they end in leaves that do not list it.
    other_mesh,       // The stored triangles are not those of the surface.
    center_distance,  // A stored signed distance of a centre is below the true one.
    distance_bound,   // A point of a ball is farther from the solid than stored.
  };
  Kind kind = Kind::uncovered;
  Index node = kNone;  // The breadth-first number; kNone if the violation belongs to no node.
  Index triangle = kNone;
  Point point = Point::Zero();  // The place, in mesh coordinates.
  // The size of the violation in mesh units: the depth outside every path region, or the difference to the bound.
  double amount = 0;
};

// The options of verify().
struct VerifyOptions {
  Index max_violations = 100;  // The maximum number that is listed; all are counted.
};

// The result of verify().
struct Verification {
  std::uint64_t triangles = 0, triangles_uncovered = 0, triangles_unlisted = 0;
  std::uint64_t nodes = 0, bounds_violated = 0;
  bool same_mesh = true;
  // The size of the part without a path, and its distance from the paths.
  UncoveredPart uncovered;
  std::vector<Index> uncovered_nodes;  // The nodes at an uncovered region, ascending.
  // The largest stored distance bound of each level, in mesh units; empty for a tree without bounds.
  std::vector<double> max_bound;
  std::vector<Violation> violations;  // Triangles come first, ascending.
  // Returns whether everything is proven.
  bool ok() const { return same_mesh && triangles_uncovered == 0 && triangles_unlisted == 0 && bounds_violated == 0; }
  // Returns whether the only violations are spheres that meet without overlapping, which no rounded computation can
  // distinguish from a gap.
  bool only_tangent(double bounding_radius) const;
};

// Verifies a packed tree. It proves from the tree's floats and the mesh alone that (a) the path rule holds, (b) every
// stored bound holds, and (c) every triangle is covered by the path regions of the leaves that list it, which implies
// (a). What is not proven counts as violated. If the surface is not solid, every point counts as outside. Precondition:
// structure_fault(tree) == nullptr. The work is parallel; the result does not depend on the number of threads.
Verification verify(const Surface& surface, const runtime::PackedSphereTree& tree, const VerifyOptions& options = {},
                    const Progress& progress = {});

// Verifies the path rule only, for balls without bounds and without lists of triangles. The work is parallel; the
// result does not depend on the number of threads.
Verification verify_path_rule(const Surface& surface, std::span<const PathBall> balls,
                              const VerifyOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
