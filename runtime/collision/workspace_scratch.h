#pragma once
#include <array>
#include <cstddef>

#include "collision/pair_walk.h"
#include "collision/triangle_cut.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime {

// The memory that contacts() and time_of_impact() use while they run.
struct Workspace::Scratch {
  detail::WalkStack walk;

  // Two triangles that meet, and their intersection, in the first tree's frame.
  struct Cut {
    detail::TrianglePoints first, second;
    std::array<detail::ShiftPlanes, 2> faces;  // face_planes() of both
    Vec3 p, q;                                 // the ends of the common segment
    std::uint32_t triangle_first, triangle_second;
  };
  static constexpr std::size_t kCuts = 512;
  std::array<Cut, kCuts> cuts;
  std::size_t cut_count = 0;

  // Two nodes that may meet next, and a lower bound on the time at which they can.
  struct TimedPair : NodePair {
    float time;
  };
  detail::TreeStack<TimedPair> timed;
};

}  // namespace orchard::runtime
