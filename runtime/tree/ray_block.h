#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/packed_tree.h"

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
