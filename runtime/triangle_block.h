#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "triangle_pair.h"

// The inner loop of the exact level: up to four triangles of one leaf against up to four of another. Planes and leaf
// balls settle most pairs; triangles_intersect() decides the rest.
namespace orchard::runtime::detail {

inline constexpr std::uint32_t kTriangleWidth = 4;

// Four triangles side by side, with a normal each (of any length).
struct TriangleBlock {
  using Lanes = std::array<double, kTriangleWidth>;
  alignas(32) std::array<std::array<Lanes, 3>, 3> corner;  // [corner][coordinate]; unused lanes repeat the first one
  alignas(32) std::array<Lanes, 3> normal;
  std::uint32_t count = 0;

  TrianglePoints points(std::uint32_t lane) const noexcept;
};

struct Ball {
  Vec3 center;
  double radius;
};

// The `count` triangles named by `triangles`, moved by `pose` unless it is null.
void load_block(const PackedSphereTree& tree, const std::uint32_t* triangles, std::uint32_t count, const Pose* pose,
                TriangleBlock& block) noexcept;

struct TriangleBlockPair {
  const TriangleBlock &rows, &lanes;
  std::uint32_t row_begin, row_end;  // the rows to test
  Ball row_ball, lane_ball;          // of the leaves, rounding included
  double size;                       // bounds every coordinate
};

// Bit 4 * row + lane: pairs that may intersect. Never leaves out a pair that shares a point of both balls.
std::uint32_t candidates(const TriangleBlockPair& pair) noexcept;
// The same, operation for operation, one number at a time: what the tests compare with, and all that some compilers
// get.
std::uint32_t candidates_scalar(const TriangleBlockPair& pair) noexcept;

}  // namespace orchard::runtime::detail
