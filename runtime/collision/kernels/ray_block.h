#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "orchard/runtime/packed_tree.h"

// Tests of a ray against eight ball slabs, and against eight triangles, at a time. Both are conservative: they may keep
// nodes and triangles that the ray misses, but drop none that it meets.
namespace orchard::runtime {

// Eight boxes side by side, along the axes of a body's frame: nodes of a ray index. Every triangle below a node lies in
// its box. Lanes that hold no node have low > high.
struct alignas(32) BoxBlock {
  using Lanes = std::array<float, kBlockWidth>;
  std::array<Lanes, 3> low{}, high{};              // [coordinate]
  std::array<std::uint32_t, kBlockWidth> child{};  // the block of the children or, with kLeafBit set, of triangles
};
static_assert(sizeof(BoxBlock) == 224 && alignof(BoxBlock) == 32);

}  // namespace orchard::runtime

namespace orchard::runtime::detail {

// The points origin + s direction in the tree's frame, with a direction of length 1. If |s| is at most twice the tree's
// size, the true ray is nowhere farther than `margin` from it. This includes the rounding of the tests of ball slabs
// and of triangles.
struct FloatRay {
  std::array<float, 3> origin{}, direction{};
  float margin = 0;
};

// A walk along a ray through the leaves of a tree, kept from one leaf to the next.
struct RayWalk {
  static constexpr std::size_t kRoom = std::size_t{kBlockWidth} * (kTriangleTreeDepthLimit + 1) + 1;

  // Precondition: 0 <= from.
  RayWalk(const FloatRay& of, float from, float to, std::uint32_t first) noexcept : ray(of), begin(from), end(to) {
    stack[0] = entry(from, first);
  }

  // A node and a lower bound on the s at which the ray enters it, in one word, so that entries compare as their s do.
  static constexpr std::uint64_t entry(float enter, std::uint32_t child) noexcept {
    return std::uint64_t{std::bit_cast<std::uint32_t>(enter)} << 32 | child;
  }
  static constexpr float enter_of(std::uint64_t entry) noexcept {
    return std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32));
  }
  static constexpr std::uint32_t child_of(std::uint64_t entry) noexcept { return static_cast<std::uint32_t>(entry); }

  const FloatRay& ray;
  float begin, end;      // the part of the ray that is searched; `end` may be made smaller between two leaves
  std::size_t size = 1;  // the number of entries on the stack
  std::array<std::uint64_t, kRoom> stack;
};

// The tree of a ray index.
struct BoxTree {
  std::span<const BoxBlock> boxes;
  std::span<const TriangleBlock> leaves;
  std::span<const float> sizes;  // the diagonals of the leaves' boxes
};

// Smaller slopes count as this, so that a ray along a slab or a plane has a finite s. As s is below 1e19, s times this
// is less than every margin.
inline constexpr float kMinSlope = 1e-12f;

// A ray for the tests against boxes and their triangles.
struct BoxRay {
  explicit BoxRay(const FloatRay& ray) noexcept;

  std::array<float, 3> near_from, far_from, inverse;  // for the planes that are met first and last, across each axis
  std::array<std::uint32_t, 3> near_side, far_side;   // the offsets of these planes in a block, in bytes
  std::array<std::uint8_t, 3> axis;                   // the order of the axes; the last one is the ray's steepest
  std::array<float, 2> shear;                         // projects along the ray to a plane across the steepest axis
};

inline BoxRay::BoxRay(const FloatRay& ray) noexcept {  // without branches: directions have no pattern
  std::array<float, 3> size{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(ray.direction[i]);
    const std::uint32_t down = bits >> 31;
    const auto turned = [&](float x) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) ^ down << 31); };
    size[i] = turned(ray.direction[i]);
    const float o = ray.origin[i], margin = turned(ray.margin);
    inverse[i] = turned(1.0f / (size[i] > kMinSlope ? size[i] : kMinSlope));
    near_from[i] = o + margin, far_from[i] = o - margin;
    const auto low = static_cast<std::uint32_t>(offsetof(BoxBlock, low) + i * sizeof(BoxBlock::Lanes));
    constexpr auto across = static_cast<std::uint32_t>(offsetof(BoxBlock, high) - offsetof(BoxBlock, low));
    near_side[i] = low + across * down, far_side[i] = low + across * (1 - down);
  }
  const auto above = [&size](std::size_t i, std::size_t j) { return static_cast<unsigned>(size[i] > size[j]); };
  const unsigned x = above(0, 1) & above(0, 2), y = (1 - x) & above(1, 2);
  axis = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(1 + (x | y)),
          static_cast<std::uint8_t>(2 - 2 * x - y)};
  for (std::size_t i = 0; i < 2; ++i) shear[i] = ray.direction[axis[i]] * inverse[axis[2]];
}

// Up to eight triangles, with bits for those that the line of the ray may meet, and for those that it certainly meets.
struct RayLeaf {
  const TriangleBlock* block = nullptr;
  std::uint32_t some = 0, sure = 0;
};

// Return the next leaf of which the ray may meet triangles; RayLeaf::block is null if there is none. The nearest node
// of a block comes first.
RayLeaf next_leaf(const TreeView& tree, RayWalk& walk) noexcept;
RayLeaf next_leaf(const BoxTree& tree, const BoxRay& ray, RayWalk& walk) noexcept;

}  // namespace orchard::runtime::detail
