#pragma once
#include <limits>
#include <vector>

#include "orchard/geometry/surface.h"

// The allowed inaccuracy of a sphere-tree, which may differ from place to place.
namespace orchard {

// Where a tree gets deeper. A node gets children only if its inaccuracy exceeds the value that is allowed at its place,
// so the depth may vary. By default every node above the builder's depth gets children. Source: dissertation 8.2.
struct Refinement {
  struct Region {
    Sphere where;
    double error = 0;  // Allowed inside, in place of the general value; in mesh units.
  };
  // The inaccuracy allowed outside all regions, in mesh units; 0 refines every node.
  double error = 0;
  std::vector<Region> regions;

  // Returns the smallest inaccuracy that is allowed anywhere in the ball, in mesh units.
  double allowed(const Sphere& ball) const {
    double min = std::numeric_limits<double>::infinity();
    for (const Region& region : regions)
      if ((region.where.center - ball.center).norm() <= region.where.radius + ball.radius && region.error < min)
        min = region.error;
    return min < std::numeric_limits<double>::infinity() ? min : error;
  }
};

// Returns whether the inaccuracy of a ball exceeds the value that is allowed at its place. If the surface is not solid,
// the distance bound of the ball replaces its inaccuracy.
bool wants_children(const Refinement& refinement, const Surface& surface, const Sphere& ball);

}  // namespace orchard
