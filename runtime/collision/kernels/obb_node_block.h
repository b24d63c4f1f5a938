#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/node_box.h"
#include "collision/kernels/placement.h"
#include "math/triangle_pair.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// The inner loops of the exact level and of distances over triangles: eight against eight.
// Every function has a twin that does the same, operation for operation, one number at a time: what the tests compare
// with, and all that some compilers get.
namespace orchard::runtime::detail {

inline ObbNode obb_node_at(const ObbNodeBlock& b, std::uint32_t i) noexcept {
  return {b.x[i], b.y[i], b.z[i], b.nx[i], b.ny[i], b.nz[i], b.radius[i], b.height[i]};
}

ObbNode moved(const ObbNode& slab, const Placement& placement) noexcept;

struct LeafPair {
  const TriangleBlock &lanes, &rows;  // of the first tree and, to be moved, of the second
  const NodeBox &lane_box, &row_box;  // around them, both in the first tree's frame
};

// Bit 8 * row + lane: pairs that may share a point. Never leaves out a pair that does.
std::uint64_t triangle_candidates(const LeafPair& pair, const Placement& placement) noexcept;
std::uint64_t triangle_candidates_scalar(const LeafPair& pair, const Placement& placement) noexcept;

// The same a row at a time, in order, as far as need be: calls visit(context, row, bits of lanes) for each row that has
// any, until it returns true, which is returned then.
using CandidateVisit = bool (*)(void* context, std::uint32_t row, std::uint32_t lanes);
bool visit_candidates(const LeafPair& pair, const Placement& placement, CandidateVisit visit, void* context) noexcept;

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
