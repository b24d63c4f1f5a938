#pragma once
#include <cstddef>

#include "collision/kernels/triangle_block.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime::test {

// How loops over blocks take a pose; `size`: of all that it moves, from the origin, and the translation.
inline detail::Placement placement_of(const Pose& pose, double size) {
  detail::Placement p{};
  for (std::size_t i = 0; i < 9; ++i) {
    p.turn[i] = static_cast<float>(pose.rotation[i]);
    p.rotation[i] = static_cast<float>(pose.rotation[i] * pose.scale);
  }
  for (std::size_t i = 0; i < 3; ++i) p.translation[i] = static_cast<float>(pose.translation[i]);
  p.scale = static_cast<float>(pose.scale);
  p.margin = static_cast<float>(size * 128 * 0x1p-24);
  p.box_margin = static_cast<float>(size * 256 * 0x1p-24);
  detail::find_rows(p);
  return p;
}

}  // namespace orchard::runtime::test
