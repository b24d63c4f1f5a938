#pragma once
#include <array>
#include <cstddef>
#include <memory>

#include "orchard/runtime/body_pair.h"
#include "pair_walk.h"

namespace orchard::runtime {

// What contacts() and time_of_impact() keep while they run.
struct Workspace::Scratch {
  detail::WalkStack walk;

  // Pairs of triangles that meet, and what they have in common, in the first tree's frame.
  struct Cut {
    detail::TrianglePoints first, second;
    detail::Vec3 p, q;  // the ends of the common segment
    std::uint32_t triangle_first, triangle_second;
  };
  static constexpr std::size_t kCuts = 512;
  std::array<Cut, kCuts> cuts;
  std::size_t cut_count = 0;

  // Pairs of ball slabs that may meet next, the second one moved, and when at the earliest.
  struct TimedPair {
    float time;
    std::uint32_t a, b;
    detail::BallSlab second;
  };
  std::unique_ptr<TimedPair[]> timed;
  std::size_t timed_room = 0;
};

}  // namespace orchard::runtime
