#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"

// What the inner loops of all pair queries work with.
namespace orchard::runtime::detail {

// The second tree's frame in the first one's, in float, and what covers the rounding.
struct Placement {
  std::array<float, 9> rotation;  // times scale
  std::array<float, 9> turn;      // without
  std::array<float, 3> translation;
  float scale;
  float slack;           // to add to a sum of radii
  float margin;          // to take from a gap between ball slabs
  float unit = 1;        // a power of two: times this, every coordinate of the pair's frame is at most 1
  float whole = 1;       // 1 / unit
  float box_margin = 0;  // to take from a gap between boxes
  // `box_margin` is large beside the smaller body, since the other one is larger by far or its origin far away: boxes
  // that floats do not separate are tested in double.
  bool coarse = false;
  // Of `turn` again, by fours: find_rows().
  alignas(16) std::array<std::array<float, 4>, 3> rows{}, columns{};
};

// What the sphere tests of one level collect, lane by lane: the smallest square - reach^2 > 0; the largest radii seen;
// and the separation bounds from which on a pair needs no test, for pairs with an inner node and for two leaves.
struct LevelState {
  alignas(32) std::array<float, kBlockWidth> min_excess, row_radius, lane_radius;
  float best_inner, best_leaf;
};

}  // namespace orchard::runtime::detail
