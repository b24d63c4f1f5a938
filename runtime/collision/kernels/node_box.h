#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "simd/vector_support.h"

// The inner loop of the exact level and of distance queries: the ball and the box of one node against those of eight
// others.
namespace orchard::runtime::detail {

// The intersection of a ball and an oriented box with the same centre. The normals of the box are n, m and their cross
// product, and its half sizes along these are height, width and length. The fourth components are 0.
struct NodeBox {
  alignas(16) std::array<float, 4> center, n, m;
  float radius, height, width, length;
};

inline NodeBox node_box_at(const ObbNodeBlock& b, std::uint32_t i) noexcept {
  return {{b.x[i], b.y[i], b.z[i], 0},
          {b.nx[i], b.ny[i], b.nz[i], 0},
          {b.mx[i], b.my[i], b.mz[i], 0},
          b.radius[i],
          b.height[i],
          b.width[i],
          b.length[i]};
}

inline NodeBox node_box_at(const TreeView& tree, std::uint32_t node) noexcept {
  return node_box_at(tree.obb_nodes[node / kBlockWidth], node % kBlockWidth);
}

inline std::array<float, 3> third_normal(const NodeBox& b) noexcept {
  const auto &n = b.n, &m = b.m;
  return {n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]};
}

// Sets Placement::rows and columns from `turn`.
inline void find_rows(Placement& placement) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) placement.rows[i][j] = placement.columns[j][i] = placement.turn[3 * i + j];
  }
}

// Returns the sum of three vectors, each times a component of `by`.
ORCHARD_INLINE std::array<float, 4> combined(const std::array<std::array<float, 4>, 3>& vectors,
                                             const std::array<float, 4>& by) noexcept {
#ifdef ORCHARD_VECTORS
  using Four __attribute__((vector_size(16))) = float;
  std::array<float, 4> result;
  store(load<Four>(vectors[0]) * by[0] + load<Four>(vectors[1]) * by[1] + load<Four>(vectors[2]) * by[2], result);
  return result;
#else
  std::array<float, 4> result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = vectors[0][i] * by[0] + vectors[1][i] * by[1] + vectors[2][i] * by[2];
  return result;
#endif
}

// Moves a box of the second tree to the first one's frame.
ORCHARD_INLINE NodeBox moved(const NodeBox& b, const Placement& p) noexcept {
  const float s = p.scale;
  NodeBox result = {combined(p.columns, b.center),
                    combined(p.columns, b.n),
                    combined(p.columns, b.m),
                    b.radius * s,
                    b.height * s,
                    b.width * s,
                    b.length * s};
  for (std::size_t i = 0; i < 3; ++i) result.center[i] = result.center[i] * s + p.translation[i];
  return result;
}

// Moves a box of the first tree to the axes and the origin of the second one; lengths stay in the first one's units.
ORCHARD_INLINE NodeBox moved_back(const NodeBox& b, const Placement& p) noexcept {
  const std::array<float, 4> from = {b.center[0] - p.translation[0], b.center[1] - p.translation[1],
                                     b.center[2] - p.translation[2], 0};
  return {combined(p.rows, from), combined(p.rows, b.n), combined(p.rows, b.m), b.radius, b.height, b.width, b.length};
}

// How far eight nodes are from a single one.
struct BoxGaps {
  using Lanes = std::array<float, kBlockWidth>;
  // A certified lower bound on the distance. If it is negative, they may meet, and lower values mean deeper overlaps.
  // Infinite for lanes without a node.
  alignas(32) Lanes gap;
  std::uint32_t used;     // bits: lanes that hold a node
  std::uint32_t meeting;  // bits: those with gap <= 0
};

// Computes the gaps between a single node and eight others. `single` is in the frame of the lanes; `scale` converts
// lengths of the lanes to its units. `margin` (Placement::box_margin) covers all rounding. The axes that are tried are
// those of both boxes (six of the fifteen of Gottschalk, Lin and Manocha 1996; the cross products of edges seldom
// decide) and the line of the centres. Along each axis, a box reaches no farther than its ball.
void box_gaps(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin, BoxGaps& result) noexcept;

// Returns whether the boxes of two nodes, each as its own tree stores it, are certainly apart along one of the same six
// axes. It computes in double, where only the reach of the other box is rounded, so that, for example, the face of a
// large wall separates it from bodies anywhere along it. `relative` is the second tree's frame in the first one's, as
// the exact test of triangles uses it.
bool boxes_are_apart(const NodeBox& first, const NodeBox& second, const Pose& relative) noexcept;

}  // namespace orchard::runtime::detail
