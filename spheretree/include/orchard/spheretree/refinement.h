#pragma once
#include <limits>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard {

// Where a tree goes deeper: a node gets children only if its inaccuracy exceeds what is allowed where it lies, so the
// depth may vary. By default every node above the builder's depth does. Source: dissertation 8.2.
struct Refinement {
  struct Region {
    Sphere where;
    double error = 0;  // allowed inside, in place of the general one; mesh units
  };
  double error = 0;  // allowed everywhere else; mesh units, 0: refine always
  std::vector<Region> regions;

  // The smallest error that is allowed anywhere in the ball, in mesh units.
  double allowed(const Sphere& ball) const {
    double min = std::numeric_limits<double>::infinity();
    for (const Region& region : regions)
      if ((region.where.center - ball.center).norm() <= region.where.radius + ball.radius && region.error < min)
        min = region.error;
    return min < std::numeric_limits<double>::infinity() ? min : error;
  }
};

// Whether a ball's inaccuracy exceeds what is allowed where it lies. If the surface is not solid, the ball's distance
// bound stands for its inaccuracy.
bool wants_children(const Refinement& refinement, const Surface& surface, const Sphere& ball);

}  // namespace orchard
