#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/obb_node_block.h"
#include "orchard/runtime/pair_front.h"

// The inner loops of a front (pair_front.h): along which unit vectors nodes and leaves are apart, and what is left
// of such gaps after the second body has moved.
namespace orchard::runtime::detail {

// How far eight nodes are from the single one, and the vectors, of length 1 to within 1e-6, along which they have their
// gaps: in the first tree's frame, from the single one to the eight, or from the first one of each two to the second.
struct BoxAxes : BoxGaps {
  alignas(32) Lanes ux, uy, uz;
};

// As box_gaps(). `placement`: where lanes and single one are in the second tree's frame, else null.
void box_axes(const NodeBox& single, const ObbNodeBlock& lanes, const Placement* placement, float margin,
              BoxAxes& result) noexcept;
// Eight of the first tree and eight of the second one, lane by lane.
void box_pair_axes(const ObbNodeBlock& firsts, const ObbNodeBlock& seconds, const Placement& placement, float margin,
                   BoxAxes& result) noexcept;

// How far all triangles of one leaf are from all of another one along a direction, at least; below 0: how far they may
// overlap along it.
struct LeafAxis {
  float gap;
  std::array<float, 3> u;
};
// The first with a gap of at least `enough`, or the best, of a given direction (none if it is null), the line of their
// ball slabs' centres, both ball slabs' normals and what follows from the best of these.
LeafAxis leaf_axis(const LeafPair& pair, const Placement& placement, const std::array<float, 3>* given,
                   float enough) noexcept;

// How the second body has moved: a point x of its own frame by turn * x + by, and two points `d` apart by up to swing *
// d differently; `error` is to be taken from every gap.
struct Shift {
  std::array<float, 9> turn;
  std::array<float, 3> by;
  float swing, error;
};
// Takes from each gap how much the two come closer along its vector at most. Bit 8 * (i % 8) + lane of open[i / 8]: no
// gap is left to that lane of blocks[i]. Returns the least of those that are left, infinite if there is none.
float close_gaps(const Shift& shift, FrontBlock* blocks, std::uint32_t count, std::uint64_t* open) noexcept;

// The same, one number at a time, for the tests.
void box_axes_scalar(const NodeBox& single, const ObbNodeBlock& lanes, const Placement* placement, float margin,
                     BoxAxes& result) noexcept;
void box_pair_axes_scalar(const ObbNodeBlock& firsts, const ObbNodeBlock& seconds, const Placement& placement,
                          float margin, BoxAxes& result) noexcept;
LeafAxis leaf_axis_scalar(const LeafPair& pair, const Placement& placement, const std::array<float, 3>* given,
                          float enough) noexcept;
float close_gaps_scalar(const Shift& shift, FrontBlock* blocks, std::uint32_t count, std::uint64_t* open) noexcept;

}  // namespace orchard::runtime::detail
