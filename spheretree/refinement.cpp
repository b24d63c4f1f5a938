#include "orchard/spheretree/refinement.h"

#include "orchard/covering/inaccuracy.h"

namespace orchard {

bool wants_children(const Refinement& refinement, const Surface& surface, const Sphere& ball) {
  const double allowed = refinement.allowed(ball);
  if (allowed <= 0) return true;
  if (!surface.solid()) return surface.distance(ball.center) + ball.radius > allowed;
  return inaccuracy(surface, ball).upper > allowed;
}

}  // namespace orchard
