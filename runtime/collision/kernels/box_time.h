#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/node_box.h"

// When two moving nodes' boxes can meet at the earliest: one against eight.
namespace orchard::runtime::detail {

// How a body turns while time goes by, seen from where the boxes are now: about `center` with the angular speed `spin`
// about `axis`, and besides by up to the angle `turning` a unit of time about anything.
struct Turning {
  std::array<float, 3> center{}, axis{};
  float spin = 0, turning = 0;
};

struct Closing {
  std::array<float, 3> velocity{};  // of the eight ones' centre less the single one's
  float speed = 0;                  // by which they may come closer besides, in any direction
  float rounding = 0;               // of places
  Turning single{}, lanes{};
};

struct BoxTimes {
  alignas(32)
      std::array<float, kBlockWidth> time;  // until then each surely does not meet the single one; 0 or less: may now
  std::uint32_t used;                       // bits: lanes that hold a node
};

// `scale` and frames as for box_gaps(). `margin` covers all rounding, and how close counts as a contact. Along a fixed
// direction u a point p of a body that turns about c comes closer by at most |axis x u| |p - c| spin a unit of time,
// since the distance from c does not change: so the gap along u, over that rate and the centres', is such a time.
void box_times(const NodeBox& single, const ObbNodeBlock& lanes, float scale, const Closing& closing, float margin,
               BoxTimes& result) noexcept;

}  // namespace orchard::runtime::detail
