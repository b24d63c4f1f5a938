#pragma once
#include <array>
#include <cstddef>

#include "collision/pair_walk.h"
#include "collision/triangle_cut.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime {

// What contacts() and time_of_impact() keep while they run.
struct Workspace::Scratch {
  detail::WalkStack walk;

  // Pairs of triangles that meet, and what they have in common, in the first tree's frame.
  struct Cut {
    detail::TrianglePoints first, second;
    std::array<detail::ShiftPlanes, 2> faces;
    Vec3 p, q;  // the ends of the common segment
    std::uint32_t triangle_first, triangle_second;
  };
  static constexpr std::size_t kCuts = 512;
  std::array<Cut, kCuts> cuts;
  std::size_t cut_count = 0;

  // Pairs of nodes that may meet next, and when at the earliest.
  struct TimedPair : NodePair {
    float time;
  };
  detail::TreeStack<TimedPair> timed;
};

}  // namespace orchard::runtime
