#include "collision/kernels/ray_block.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "collision/kernels/eight.h"
#include "simd/machine.h"

// Rounding, with u = 2^-24. Let D be the size of the tree's coordinates and of s.
// Ball slabs: the distance of a centre from the line is the length of a cross product of differences below 2 D and of a
// unit vector, and a height over the middle plane is such a dot product. Both are off by less than 16 u D, which
// FloatRay::margin covers besides the line's own error. Half the length of the part of the line inside a ball is the
// square root of a difference of squares; kGrazing times the greater square covers its rounding.
// Triangles: corners relative to a point of the line nearby are off by at most the margin, and nowhere longer than L. A
// product of three such vectors, one of them of length 1, is off by less than 4 L margin + 16 u L^2. After shearing
// onto a plane, by slopes of at most 1, the two components are at most 2 L and off by less than two margins and 4 u L,
// so a product of two of them is off by less than 4 * 2 L * (2 margin + 4 u L) + 3 u * 8 L^2 < 16 L margin + 64 u L^2.
namespace orchard::runtime::detail {
namespace {

constexpr float kGrazing = 0x1p-20f;
constexpr float kProductError = 0x1p-20f;
constexpr float kShearedError = 0x1p-18f;
constexpr float kMinRoom = 1e-33f;  // covers the underflow of a product

using RayEntries = std::array<float, kBlockWidth>;

// Stores lower bounds on the s at which the ray enters each ball slab, but at least `begin`. Returns the bits of the
// ball slabs that the ray may meet between begin and end.
template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE std::uint32_t find_obb_nodes(const FloatRay& ray, const ObbNodeBlock& obb_nodes, float begin, float end,
                                            RayEntries& entries) noexcept {
  const Vectors d = E::all_of(ray.direction);
  const Vectors n = {load<Floats>(obb_nodes.nx), load<Floats>(obb_nodes.ny), load<Floats>(obb_nodes.nz)};
  const Vectors to = E::minus({load<Floats>(obb_nodes.x), load<Floats>(obb_nodes.y), load<Floats>(obb_nodes.z)},
                              E::all_of(ray.origin));
  const Floats zero = E::all(0.0f), margin = E::all(ray.margin), radius = load<Floats>(obb_nodes.radius);
  const Floats r = radius + margin, h = load<Floats>(obb_nodes.height) + margin;
  const Vectors across = E::cross(to, d);
  const Floats square = r * r, apart = E::dot(across, across), inside = square - apart;
  const Floats middle = E::dot(to, d);
  const Floats half = Kind::sqrt(E::max(inside, zero) + square * E::all(kGrazing)) + margin;
  // The ray is between the planes where |s (n . d) - n . to| <= h.
  const Floats slope = E::dot(n, d), height = E::dot(n, to);
  const Floats steep = E::max(E::abs(slope), E::all(kMinSlope));
  const Floats rise = Kind::choose(slope < zero, -height, height);
  const Floats low = (rise - h) / steep, high = (rise + h) / steep;
  // If `low` is infinite, the first argument is not a number, and max() returns the second one.
  const Floats enter = E::max(E::max(low - E::abs(low) * E::all(kGrazing), middle - half), E::all(begin));
  const Floats leave = E::min(middle + half, high + E::abs(high) * E::all(kGrazing));
  store(enter, entries);
  // The comparisons are written so that values that are not numbers, from infinite quotients, count as met.
  const auto missed = (inside < zero) | (leave < enter) | (E::all(end) < enter);
  return Kind::bits(zero <= radius) & ~Kind::bits(missed);
}

// Decides on which side of the edges the line passes, from the products for each two neighbouring corners. These are
// off by less than `room`.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE RayLeaf told_apart(const TriangleBlock& block, const typename Kind::Floats& p,
                                  const typename Kind::Floats& q, const typename Kind::Floats& r,
                                  const typename Kind::Floats& room) noexcept {
  const auto least = E::min(E::min(p, q), r), most = E::max(E::max(p, q), r);
  const std::uint32_t some = E::kAll & ~Kind::bits((least < -room) & (room < most));
  if (some == 0) return {&block, 0, 0};
  return {&block, some & used_lanes(block), Kind::bits((room < least) | (most < -room))};
}

template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE RayLeaf find_triangles(const FloatRay& ray, const TriangleBlock& block) noexcept {
  const Vectors d = E::all_of(ray.direction);
  // Coordinates are relative to a point of the line near the first triangle, so that products are only as large as the
  // leaf.
  float at = 0;
  for (std::size_t i = 0; i < 3; ++i) at += (block.corner[0][i][0] - ray.origin[i]) * ray.direction[i];
  const Vectors from = {E::all(ray.origin[0] + at * ray.direction[0]), E::all(ray.origin[1] + at * ray.direction[1]),
                        E::all(ray.origin[2] + at * ray.direction[2])};
  const Vectors a = E::minus(E::corner(block, 0), from), b = E::minus(E::corner(block, 1), from),
                c = E::minus(E::corner(block, 2), from);
  const Floats longest = E::max(E::max(E::one_norm(a), E::one_norm(b)), E::one_norm(c));
  const Floats room = longest * (E::all(4 * ray.margin) + longest * E::all(kProductError)) + E::all(kMinRoom);
  const Floats p = E::dot(d, E::cross(a, b)), q = E::dot(d, E::cross(b, c)), r = E::dot(d, E::cross(c, a));
  return told_apart<Kind>(block, p, q, r, room);
}

// Stores the smaller number in `least` and returns the other one, without a branch.
ORCHARD_INLINE std::uint64_t put_in_order(std::uint64_t& least, std::uint64_t other) noexcept {
  const std::uint64_t change = (least ^ other) & (0 - std::uint64_t{other < least});
  least ^= change;
  return other ^ change;
}

// Continues a walk up to the next leaf with triangles that may be met. `Nodes` tests the nodes of a block and the
// triangles of a leaf.
template <typename Nodes>
ORCHARD_INLINE RayLeaf find_leaf(const Nodes& nodes, std::span<const TriangleBlock> leaves, RayWalk& walk) noexcept {
  const float end = walk.end;
  std::uint64_t* const bottom = walk.stack.data();
  std::uint64_t* top = bottom + walk.size;
  RayEntries entries;
  while (top > bottom) {
    std::uint64_t next = *--top;
    if (RayWalk::enter_of(next) > end) continue;
    std::uint32_t child = RayWalk::child_of(next);
    while ((child & kLeafBit) == 0) {
      const auto& block = nodes.blocks[child];
      std::uint32_t left = nodes.met(block, end, entries);
      if (left == 0) break;
      const auto at = [&](std::uint32_t bits) ORCHARD_INLINE_LAMBDA {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits)) % kBlockWidth;
        return RayWalk::entry(entries[lane], block.child[lane]);
      };
      // The walk goes on with the nearest node, and the others are pushed. No branch distinguishes one node from two,
      // because it could not be predicted.
      next = at(left);
      left &= left - 1;
      const std::uint64_t none = 0 - std::uint64_t{left == 0};
      *top = put_in_order(next, at(left) | none);
      top += left != 0;
      for (left &= left - 1; left != 0; left &= left - 1) *top++ = put_in_order(next, at(left));
      child = RayWalk::child_of(next);
    }
    if ((child & kLeafBit) == 0) continue;
    const RayLeaf leaf = nodes.triangles(leaves[child & ~kLeafBit], next);
    if (leaf.some == 0) continue;
    walk.size = static_cast<std::size_t>(top - bottom);
    return leaf;
  }
  walk.size = 0;
  return {};
}

template <typename Kind>
struct ObbNodes {
  const FloatRay& ray;
  float begin;
  std::span<const ObbNodeBlock> blocks;
  ORCHARD_INLINE std::uint32_t met(const ObbNodeBlock& block, float end, RayEntries& entries) const noexcept {
    return find_obb_nodes<Kind>(ray, block, begin, end, entries);
  }
  ORCHARD_INLINE RayLeaf triangles(const TriangleBlock& block, std::uint64_t) const noexcept {
    return find_triangles<Kind>(ray, block);
  }
};

// Tests a ray against boxes by the places at which it crosses their planes. For near planes, these places are computed
// from `margin` further on; for far planes, from `margin` further back. This covers all rounding, which has the effect
// of planes at slightly wrong places. Triangles are sheared along the ray onto a plane across the axis along which the
// ray is steepest.
template <typename Kind>
struct Boxes {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  const BoxTree& tree;
  const BoxRay& own;
  const FloatRay& ray;
  std::span<const BoxBlock> blocks;
  Floats near_from[3], far_from[3], inverse[3], begin;

  ORCHARD_INLINE Boxes(const BoxTree& of, const BoxRay& box_ray, const RayWalk& walk) noexcept
      : tree(of), own(box_ray), ray(walk.ray), blocks(of.boxes), begin(E::all(walk.begin)) {
    for (std::size_t i = 0; i < 3; ++i) {
      near_from[i] = E::all(own.near_from[i]), far_from[i] = E::all(own.far_from[i]);
      inverse[i] = E::all(own.inverse[i]);
    }
  }

  ORCHARD_INLINE static Floats load_at(const std::byte* planes) noexcept {
    Floats result;
    std::memcpy(&result, planes, sizeof result);
    return result;
  }

  ORCHARD_INLINE std::uint32_t met(const BoxBlock& block, float end, RayEntries& entries) const noexcept {
    const auto* const bytes = reinterpret_cast<const std::byte*>(&block);
    const auto at = [&](std::size_t side, const Floats& from, std::size_t i)
                        ORCHARD_INLINE_LAMBDA { return (load_at(bytes + side) - from) * inverse[i]; };
    const Floats enter = E::max(E::max(at(own.near_side[0], near_from[0], 0), at(own.near_side[1], near_from[1], 1)),
                                E::max(at(own.near_side[2], near_from[2], 2), begin));
    const Floats leave = E::min(E::min(at(own.far_side[0], far_from[0], 0), at(own.far_side[1], far_from[1], 1)),
                                E::min(at(own.far_side[2], far_from[2], 2), E::all(end)));
    store(enter, entries);
    return Kind::bits(enter <= leave);
  }

  // Coordinates are relative to the point at which the ray enters the leaf's box, or passes it within the margin. So no
  // corner is farther away than the box's diagonal and some margins.
  ORCHARD_INLINE RayLeaf triangles(const TriangleBlock& block, std::uint64_t leaf) const noexcept {
    const float reach = tree.sizes[RayWalk::child_of(leaf) & ~kLeafBit] + 8 * ray.margin;
    const Floats room = E::all(reach * (16 * ray.margin + reach * kShearedError) + kMinRoom);
    Floats x[3], y[3];
    const float enter = RayWalk::enter_of(leaf);
    const auto from = [&](std::size_t i)
                          ORCHARD_INLINE_LAMBDA { return E::all(ray.origin[i] + enter * ray.direction[i]); };
    const auto [u, v, w] = own.axis;
    const Floats from_x = from(u), from_y = from(v), from_z = from(w);
    const Floats shear_x = E::all(own.shear[0]), shear_y = E::all(own.shear[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Floats z = load<Floats>(block.corner[k][w]) - from_z;
      x[k] = (load<Floats>(block.corner[k][u]) - from_x) - shear_x * z;
      y[k] = (load<Floats>(block.corner[k][v]) - from_y) - shear_y * z;
    }
    const Floats p = x[0] * y[1] - y[0] * x[1], q = x[1] * y[2] - y[1] * x[2], r = x[2] * y[0] - y[2] * x[0];
    return told_apart<Kind>(block, p, q, r, room);
  }
};

template <typename Kind>
ORCHARD_INLINE RayLeaf find_leaf_of_tree(const TreeView& tree, RayWalk& walk) noexcept {
  return find_leaf(ObbNodes<Kind>{walk.ray, walk.begin, tree.obb_nodes}, tree.triangle_blocks, walk);
}

template <typename Kind>
ORCHARD_INLINE RayLeaf find_leaf_of_boxes(const BoxTree& tree, const BoxRay& ray, RayWalk& walk) noexcept {
  return find_leaf(Boxes<Kind>(tree, ray, walk), tree.leaves, walk);
}

}  // namespace

RayLeaf next_leaf(const TreeView& tree, RayWalk& walk) noexcept {
  return PerMachine<find_leaf_of_tree<Widest>, find_leaf_of_tree<Base>, find_leaf_of_tree<PlainFloats>>::call(tree,
                                                                                                              walk);
}

RayLeaf next_leaf(const BoxTree& tree, const BoxRay& ray, RayWalk& walk) noexcept {
  return PerMachine<find_leaf_of_boxes<Widest>, find_leaf_of_boxes<Base>, find_leaf_of_boxes<PlainFloats>>::call(
      tree, ray, walk);
}

}  // namespace orchard::runtime::detail
