#pragma once
#include <cmath>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/random.h"

namespace orchard {

// A uniformly distributed direction: random points of the cube are drawn until one lies in the unit ball, and that is
// normalised. Without sine and cosine, so that the result is the same on every machine.
inline Vector random_direction(Random& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const double squared = x * x + y * y + z * z;
    if (squared <= 1 && squared > 1e-6) return Vector(x, y, z) / std::sqrt(squared);
  }
}

}  // namespace orchard
