#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "pair/triangle_pair.h"

// The inner loops of the exact level and of distances: one ball slab against eight, and eight triangles against eight.
// Every function has a twin that does the same, operation for operation, one number at a time: what the tests compare
// with, and all that some compilers get.
namespace orchard::runtime::detail {

inline BallSlab ball_slab_at(const BallSlabBlock& b, std::uint32_t i) noexcept {
  return {b.x[i], b.y[i], b.z[i], b.nx[i], b.ny[i], b.nz[i], b.radius[i], b.height[i]};
}

BallSlab moved(const BallSlab& slab, const Placement& placement) noexcept;

// Eight ball slabs as they were tested, in the first tree's frame, and how far each is from the single one.
struct BallSlabGaps {
  using Lanes = std::array<float, kBlockWidth>;
  alignas(32) Lanes x, y, z, nx, ny, nz, radius, height;
  alignas(32) Lanes gap;  // certified lower bound on the distance; negative: they may meet, the lower the deeper
  std::uint32_t used;     // bits: lanes that hold a ball slab
  std::uint32_t meeting;  // bits: those with gap <= 0

  BallSlab slab(std::uint32_t i) const noexcept {
    return {x[i], y[i], z[i], nx[i], ny[i], nz[i], radius[i], height[i]};
  }
};

// `placement` moves the lanes unless it is null; `margin` (Placement::margin) covers all rounding.
void ball_slab_gaps(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                    BallSlabGaps& result) noexcept;
void ball_slab_gaps_scalar(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                           BallSlabGaps& result) noexcept;

// The same where only those that meet matter: of the others the result holds anything.
void meeting_ball_slabs(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement, float margin,
                        BallSlabGaps& result) noexcept;
void meeting_ball_slabs_scalar(const BallSlab& single, const BallSlabBlock& lanes, const Placement* placement,
                               float margin, BallSlabGaps& result) noexcept;

struct LeafPair {
  const TriangleBlock &lanes, &rows;  // of the first tree and, to be moved, of the second
  BallSlab lane_slab, row_slab;       // around them, both in the first tree's frame
};

// Bit 8 * row + lane: pairs that may share a point. Never leaves out a pair that does.
std::uint64_t triangle_candidates(const LeafPair& pair, const Placement& placement) noexcept;
std::uint64_t triangle_candidates_scalar(const LeafPair& pair, const Placement& placement) noexcept;

// Certified lower bounds on the distances of triangles, below 0 where none is known; unused rows and lanes hold
// anything.
struct TriangleGaps {
  alignas(32) std::array<std::array<float, kBlockWidth>, kBlockWidth> lower;  // [row][lane]
  std::array<std::uint32_t, kBlockWidth> near;  // [row], bits: lanes that are no farther than `reach`
  float beyond;                                 // the least of all others, or infinite
};
// `direction`: one more axis to try, of length 1 at most. Rows that are all farther than `reach` get no closer bounds
// than need be to see that.
void triangle_gaps(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                   const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept;
void triangle_gaps_scalar(const TriangleBlock& lanes, const TriangleBlock& rows, const Placement& placement,
                          const std::array<float, 3>& direction, float reach, TriangleGaps& result) noexcept;

TrianglePoints points_of(const TriangleBlock& block, std::uint32_t lane) noexcept;
TrianglePoints moved_points_of(const TriangleBlock& block, std::uint32_t lane, const Pose& pose) noexcept;

}  // namespace orchard::runtime::detail
