#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/placement.h"
#include "orchard/runtime/packed_tree.h"

// When two moving ball slabs can meet at the earliest: one against eight.
namespace orchard::runtime::detail {

// How a body turns while time goes by, seen from the first tree's frame as it is now: about `center` with the angular
// speed `spin` about `axis`, and besides by up to the angle `turning` a unit of time about anything.
struct Turning {
  std::array<float, 3> center{}, axis{};
  float spin = 0, turning = 0;
};

struct Closing {
  std::array<float, 3> velocity{};  // of the second one's centre less the first one's
  float speed = 0;                  // by which they may come closer besides, in any direction
  Turning first, second;
};

// Eight ball slabs as they were tested, in the first tree's frame, and until when each surely does not meet the single
// one (0 or less: they may now).
struct ObbNodeTimes {
  using Lanes = std::array<float, kBlockWidth>;
  alignas(32) Lanes x, y, z, nx, ny, nz, radius, height;
  alignas(32) Lanes time;
  std::uint32_t used;  // bits: lanes that hold a ball slab

  ObbNode slab(std::uint32_t i) const noexcept { return {x[i], y[i], z[i], nx[i], ny[i], nz[i], radius[i], height[i]}; }
};

// `placement` moves the lanes unless it is null: then they belong to the second tree, and the single one to the first,
// otherwise the other way round. `margin` covers all rounding, and how close counts as a contact. Along a fixed
// direction u a point p of a body that turns about c comes closer by at most |axis x u| |p - c| spin a unit of time,
// since the distance from c does not change: so the gap along u, over that rate and the centres', is such a time.
void obb_node_times(const ObbNode& single, const ObbNodeBlock& lanes, const Placement* placement,
                    const Closing& closing, float margin, ObbNodeTimes& result) noexcept;
void obb_node_times_scalar(const ObbNode& single, const ObbNodeBlock& lanes, const Placement* placement,
                           const Closing& closing, float margin, ObbNodeTimes& result) noexcept;

}  // namespace orchard::runtime::detail
