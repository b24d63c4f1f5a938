#pragma once
#include <limits>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard {

// Where a tree goes deeper (dissertation 8.2): a node gets children only if its inaccuracy exceeds what is allowed
// there, so depth may vary. By default every node down to the builder's depth.
struct Refinement {
  struct Region {
    Sphere where;
    double error = 0;  // allowed inside, in place of the general one; mesh units
  };
  double error = 0;  // allowed everywhere else; mesh units, 0: refine always
  std::vector<Region> regions;

  // The least that is allowed anywhere in the ball.
  double allowed(const Sphere& ball) const {
    double min = std::numeric_limits<double>::infinity();
    for (const Region& region : regions)
      if ((region.where.center - ball.center).norm() <= region.where.radius + ball.radius && region.error < min)
        min = region.error;
    return min < std::numeric_limits<double>::infinity() ? min : error;
  }
};

// Whether a ball's inaccuracy exceeds what is allowed there. If the surface is not solid, its distance bound stands for
// the inaccuracy.
bool wants_children(const Refinement& refinement, const Surface& surface, const Sphere& ball);

}  // namespace orchard
