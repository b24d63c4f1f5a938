#pragma once
#include <array>
#include <cstdint>

#include "collision/kernels/node_box.h"

// The earliest time at which the boxes of two moving nodes can meet: one node against eight.
namespace orchard::runtime::detail {

// The rotation of a body, in the frame in which the boxes are now. It turns about `center` with the angular speed
// `spin` about `axis`. In addition, it may turn about any axis with an angular speed of at most `turning`.
struct Turning {
  std::array<float, 3> center{}, axis{};
  float spin = 0, turning = 0;
};

// The relative motion of the eight nodes and the single one.
struct Closing {
  std::array<float, 3> velocity{};  // the velocity of the centre of the eight ones relative to that of the single one
  float speed = 0;                  // a bound on the error of that, in any direction
  float rounding = 0;               // a bound on the rounding of places
  Turning single{}, lanes{};
};

// The result of box_times(). A time of at most 0 means that they may meet now.
struct BoxTimes {
  alignas(32) std::array<float, kBlockWidth> time;  // before it, each certainly does not meet the single one
  std::uint32_t used;                               // bits: lanes that hold a node
};

// Computes lower bounds on the times at which eight nodes can meet the single one. `scale` and the frames are those of
// box_gaps(). `margin` covers all rounding and the distance that counts as a contact. Along a fixed direction u, a
// point p of a body that turns about c comes closer by at most |axis x u| |p - c| spin per unit of time, because its
// distance from c does not change. So the gap along u, divided by the sum of that rate for both bodies and of the speed
// of the centres, is such a time.
void box_times(const NodeBox& single, const ObbNodeBlock& lanes, float scale, const Closing& closing, float margin,
               BoxTimes& result) noexcept;

}  // namespace orchard::runtime::detail
