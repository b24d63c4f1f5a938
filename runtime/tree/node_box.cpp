#include "node_box.h"

#include "box_pair.h"
#include "eight.h"
#include "machine.h"

namespace orchard::runtime::detail {
namespace {

template <typename Kind>
ORCHARD_INLINE void find_gaps(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                              BoxGaps& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  const Boxes<Kind> p = Boxes<Kind>::of(single), q = Boxes<Kind>::of(lanes, scale, 0);
  const BoxPair<Kind> pair(p, q);
  BestGap<Kind> best = {pair.ball_gap};
  pair.find(best);
  const Floats gap = best.gap - E::all(margin);
  store(gap, result.gap);
  result.used = Kind::bits(E::all(0.0f) <= load<Floats>(lanes.radius));
  result.meeting = result.used & Kind::bits(gap <= E::all(0.0f));
}

void find_gaps_one_by_one(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                          bool only_meeting, BoxGaps& result) noexcept {
  const Boxes<OneFloat> p = Boxes<OneFloat>::of(single);
  result.used = result.meeting = 0;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
    const bool in_use = lanes.radius[i] >= 0;
    result.used |= std::uint32_t{in_use} << i;
    if (only_meeting && !in_use) continue;
    const Boxes<OneFloat> q = Boxes<OneFloat>::of(lanes, scale, i);
    const BoxPair<OneFloat> pair(p, q);
    if (only_meeting && pair.ball_gap - margin > 0) continue;
    BestGap<OneFloat> best = {pair.ball_gap};
    pair.find(best);
    result.gap[i] = best.gap - margin;
    result.meeting |= std::uint32_t{in_use && result.gap[i] <= 0} << i;
  }
}

}  // namespace

void box_gaps_scalar(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                     BoxGaps& result) noexcept {
  find_gaps_one_by_one(single, lanes, scale, margin, false, result);
}

void meeting_boxes_scalar(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                          BoxGaps& result) noexcept {
  find_gaps_one_by_one(single, lanes, scale, margin, true, result);
}

// Without vectors the compiler's own are slower than one number at a time that stops early.
#ifdef ORCHARD_VECTORS
void box_gaps(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  PerMachine<find_gaps<Widest>, find_gaps<Base>>::call(single, lanes, scale, margin, result);
}
void meeting_boxes(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                   BoxGaps& result) noexcept {
  box_gaps(single, lanes, scale, margin, result);
}
#else
void box_gaps(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  box_gaps_scalar(single, lanes, scale, margin, result);
}
void meeting_boxes(const NodeBox& single, const BallSlabBlock& lanes, float scale, float margin,
                   BoxGaps& result) noexcept {
  meeting_boxes_scalar(single, lanes, scale, margin, result);
}
#endif

}  // namespace orchard::runtime::detail
