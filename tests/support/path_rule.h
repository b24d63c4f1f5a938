#pragma once
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"

namespace orchard::test {

// Closed sets, no tolerance: what the certificate promises.
inline bool in_some_path_region(const Point& point, std::span<const PathBall> balls) {
  std::vector<char> inside(balls.size(), 0);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    inside[i] =
        (balls[i].parent == kNone || inside[balls[i].parent]) && (point - balls[i].center).norm() <= balls[i].radius;
    if (inside[i] && balls[i].leaf) return true;
  }
  return false;
}

}  // namespace orchard::test
