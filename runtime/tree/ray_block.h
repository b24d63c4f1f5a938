#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/ray_index.h"

// A ray against eight ball slabs and against eight triangles at a time. Both may let through what the ray misses, but
// keep everything that it meets.
namespace orchard::runtime::detail {

// The points origin + s direction, in the tree's frame, the direction of length 1: the true ray is nowhere farther than
// `margin` from it, where |s| is at most the tree's size, the rounding of a ball slab's and a triangle's own test
// included.
struct FloatRay {
  std::array<float, 3> origin{}, direction{};
  float margin = 0;
};

// A walk along a ray through the leaves of a tree, kept from one leaf to the next.
struct RayWalk {
  static constexpr std::size_t kRoom = std::size_t{kBlockWidth} * (kTriangleTreeDepthLimit + 1) + 1;
  struct Entry {
    float enter;  // the s at which the ray enters the node, not too late
    std::uint32_t child;
  };

  RayWalk(const FloatRay& of, float from, float to, std::uint32_t first) noexcept : ray(of), begin(from), end(to) {
    stack[0] = {begin, first};
  }

  const FloatRay& ray;
  float begin, end;      // the part of the ray that is looked at; `end` may be made smaller between two leaves
  std::size_t size = 1;  // entries of the stack
  std::array<Entry, kRoom> stack;
};

// What a ray index holds.
struct BoxTree {
  std::span<const BoxBlock> boxes;
  std::span<const TriangleBlock> leaves;
  std::span<const float> sizes;  // of the leaves' boxes: the diagonals
};

// A ray for the tests against boxes and their triangles.
struct BoxRay {
  explicit BoxRay(const FloatRay& ray) noexcept;

  std::array<float, 3> near_from, far_from, inverse;  // for the planes met first and last, across each axis
  std::array<std::uint8_t, 3> near_side, far_side;    // which these are, of low[0], .., high[2]
  std::array<std::uint8_t, 3> axis;                   // the last one is the ray's steepest
  std::array<float, 2> shear;                         // along the ray, onto a plane across that one
};

// Eight triangles at most, and the bits of those that the ray's line may meet.
struct RayLeaf {
  const TriangleBlock* block = nullptr;
  std::uint32_t some = 0;
};

// The next leaf on the ray of which triangles may be met, the nearest node of a block first; without a block where
// there is none.
RayLeaf next_leaf(const TreeView& tree, RayWalk& walk) noexcept;
RayLeaf next_leaf(const BoxTree& tree, const BoxRay& ray, RayWalk& walk) noexcept;

// The s at which the ray enters each ball slab, not too late; bits of the ball slabs that it meets between begin and
// end.
using RayEntries = std::array<float, kBlockWidth>;
std::uint32_t ray_ball_slabs(const FloatRay& ray, const BallSlabBlock& ball_slabs, float begin, float end,
                             RayEntries& entries) noexcept;
std::uint32_t ray_ball_slabs_scalar(const FloatRay& ray, const BallSlabBlock& ball_slabs, float begin, float end,
                                    RayEntries& entries) noexcept;

// Bits of the triangles that the ray's line may meet.
std::uint32_t ray_triangles(const FloatRay& ray, const TriangleBlock& block) noexcept;
std::uint32_t ray_triangles_scalar(const FloatRay& ray, const TriangleBlock& block) noexcept;

}  // namespace orchard::runtime::detail
