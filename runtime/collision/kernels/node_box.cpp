#include "collision/kernels/node_box.h"

#include "collision/kernels/box_pair.h"
#include "collision/kernels/eight.h"
#include "math/vector_functions.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

// A box in double. Its axes are unit and across each other to 1e-6 only.
struct WideBox {
  Vec3 center;
  std::array<Vec3, 3> axes;
  Vec3 half;
  double radius;

  explicit WideBox(const NodeBox& b) noexcept
      : center(wide(b.center)),
        axes({wide(b.n), wide(b.m), wide(third_normal(b))}),
        half(double{b.height}, double{b.width}, double{b.length}),
        radius(double{b.radius}) {}

  WideBox(const NodeBox& b, const Pose& pose) noexcept : WideBox(b) {
    center = transform(pose, center);
    for (Vec3& axis : axes) axis = rotate(pose, axis);
    for (double& x : half) x *= pose.scale;
    radius *= pose.scale;
  }

  // How far it reaches along a vector of length 1 to within 1e-6, at least.
  double reach(const Vec3& u) const noexcept {
    constexpr double kSkew = 0x1p-18;
    double sum = kSkew * radius;
    for (std::size_t i = 0; i < 3; ++i) sum += half[i] * std::fabs(dot(u, axes[i]));
    return std::min(sum, radius * (1 + kSkew));
  }

 private:
  template <typename Floats>
  static Vec3 wide(const Floats& v) noexcept {
    return {double{v[0]}, double{v[1]}, double{v[2]}};
  }
};

// Along an axis of its own a box reaches exactly as far as is stored.
bool parted_by_axis(const WideBox& of, const WideBox& other, double error) noexcept {
  const Vec3 d = minus(other.center, of.center);
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = std::fabs(dot(d, of.axes[i]));
    if (along - of.half[i] - other.reach(of.axes[i]) > error) return true;
  }
  return false;
}

template <typename Kind>
ORCHARD_INLINE void find_gaps(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
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

void find_gaps_one_by_one(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
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

bool boxes_are_apart(const NodeBox& first, const NodeBox& second, const Pose& relative) noexcept {
  const WideBox p(first), q(second, relative);
  // Some operations on the coordinates of centres, and what a rotation lacks to be one (kRigidTolerance), which turns
  // the boxes.
  double error = 0x1p-36 * (p.radius + q.radius);
  for (std::size_t i = 0; i < 3; ++i) error += 0x1p-46 * (std::fabs(p.center[i]) + std::fabs(q.center[i]));
  return parted_by_axis(p, q, error) || parted_by_axis(q, p, error);
}

void box_gaps_scalar(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
                     BoxGaps& result) noexcept {
  find_gaps_one_by_one(single, lanes, scale, margin, false, result);
}

void meeting_boxes_scalar(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
                          BoxGaps& result) noexcept {
  find_gaps_one_by_one(single, lanes, scale, margin, true, result);
}

// Without vectors the compiler's own are slower than one number at a time that stops early.
#ifdef ORCHARD_VECTORS
void box_gaps(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  PerMachine<find_gaps<Widest>, find_gaps<Base>>::call(single, lanes, scale, margin, result);
}
void meeting_boxes(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
                   BoxGaps& result) noexcept {
  box_gaps(single, lanes, scale, margin, result);
}
#else
void box_gaps(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  box_gaps_scalar(single, lanes, scale, margin, result);
}
void meeting_boxes(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
                   BoxGaps& result) noexcept {
  meeting_boxes_scalar(single, lanes, scale, margin, result);
}
#endif

}  // namespace orchard::runtime::detail
