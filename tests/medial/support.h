#pragma once
#include <gtest/gtest.h>

#include <algorithm>

#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"

namespace orchard::test {

// The farthest that a segment between adjacent medial vertices leaves the solid, at eight points on each; a fraction of
// the bounding radius, 0 if none does.
inline double farthest_outside(const Surface& surface, const MedialAxis& axis) {
  double farthest = 0;
  for (Index a = 0; a < axis.size(); ++a) {
    for (const Index b : axis.neighbors[a]) {
      if (b < a) continue;
      for (int k = 1; k < 9; ++k) {
        const Point query = axis.centers[a] + k / 9.0 * (axis.centers[b] - axis.centers[a]);
        farthest = std::max(farthest, surface.signed_distance(query));
      }
    }
  }
  return farthest / surface.bounding_radius();
}

inline Index count_components(const MedialAxis& axis) {
  Index count = 0;
  connected_components(axis, count);
  return count;
}

}  // namespace orchard::test
