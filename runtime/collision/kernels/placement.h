#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"

// The input that the inner loops of all pair queries share.
namespace orchard::runtime::detail {

// The second tree's frame in the first one's, in float, and margins that cover the rounding.
struct Placement {
  std::array<float, 9> rotation;  // times `scale`
  std::array<float, 9> turn;      // the rotation without `scale`
  std::array<float, 3> translation;
  float scale;
  float slack;           // is added to a sum of radii
  float margin;          // is subtracted from a gap between triangles, or to a plane of a box
  float unit = 1;        // a power of two; every coordinate of the pair's frame, times this, is at most 1
  float whole = 1;       // 1 / unit
  float box_margin = 0;  // is subtracted from a gap between boxes
  // `box_margin` is large compared with the smaller body, because the other one is much larger or its origin is far
  // away. Boxes that floats do not separate are then tested in double.
  bool coarse = false;
  // The rows and the columns of `turn` with four components each; see find_rows().
  alignas(16) std::array<std::array<float, 4>, 3> rows{}, columns{};
};

// What the sphere tests of one level collect in each lane: the smallest positive value of square - reach^2, and the
// largest radii. `best_inner` and `best_leaf` are the best separation bounds so far, of pairs with an inner node and of
// two leaves; pairs with larger bounds need not be looked at.
struct LevelState {
  alignas(32) std::array<float, kBlockWidth> min_excess, row_radius, lane_radius;
  float best_inner, best_leaf;
};

}  // namespace orchard::runtime::detail
