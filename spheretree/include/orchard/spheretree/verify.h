#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/covering/uncovered_part.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard {

// What a packed tree promises and verify() could not prove.
struct Violation {
  enum class Kind : std::uint8_t {
    uncovered,        // a point of a triangle that no path region is certain to hold
    unlisted,         // the triangle has its paths, but they end in leaves that do not list it
    other_mesh,       // the stored triangles are not the surface's
    center_distance,  // a stored signed distance of a centre is below the true one
    distance_bound,   // a point of a ball is farther from the solid than stored
  };
  Kind kind = Kind::uncovered;
  Index node = kNone;  // breadth-first number; kNone if none is to blame
  Index triangle = kNone;
  Point point = Point::Zero();  // where, in mesh coordinates
  double amount = 0;            // by how much: depth outside every path region, or bound missed, in mesh units
};

struct VerifyOptions {
  Index max_violations = 100;  // that are listed; all are counted
};

struct Verification {
  std::uint64_t triangles = 0, triangles_uncovered = 0, triangles_unlisted = 0;
  std::uint64_t nodes = 0, bounds_violated = 0;
  bool same_mesh = true;
  UncoveredPart uncovered;             // how much has no path, and how far off the paths are
  std::vector<Index> uncovered_nodes;  // that bound an uncovered region, ascending
  std::vector<double> max_bound;       // stored distance bound by level, in mesh units; none in a tree without bounds
  std::vector<Violation> violations;   // triangles first, ascending
  bool ok() const { return same_mesh && triangles_uncovered == 0 && triangles_unlisted == 0 && bounds_violated == 0; }
  // Nothing is wrong but that spheres meet without overlapping, which no rounded computation can tell from a gap.
  bool only_tangent(double bounding_radius) const;
};

// Verifies a packed tree: proves from its floats and the mesh alone that (a) the path rule holds, (b) every stored
// bound holds, (c) every triangle is covered by the path regions of the leaves that list it, which implies (a). What is
// not proven counts as violated. If the surface is not solid, every point counts as outside. Precondition:
// structure_fault(tree) == nullptr. Parallel; the result does not depend on the thread count.
Verification verify(const Surface& surface, const runtime::PackedSphereTree& tree, const VerifyOptions& options = {},
                    const Progress& progress = {});

// Verifies the path rule alone, for a tree that promises nothing else: balls without bounds and without lists of
// triangles. Parallel; the result does not depend on the thread count.
Verification verify_path_rule(const Surface& surface, std::span<const PathBall> balls,
                              const VerifyOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
