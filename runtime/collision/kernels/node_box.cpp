#include "collision/kernels/node_box.h"

#include <limits>

#include "collision/kernels/box_pair.h"
#include "collision/kernels/eight.h"
#include "math/vector_functions.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

// A box in double. Its axes are orthonormal only to 1e-6.
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

  // Returns an upper bound on how far the box reaches along a vector whose length is 1 to within 1e-6.
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

// Returns whether an axis of the first box separates the boxes by more than `error`. Along its own axes, a box reaches
// exactly as far as is stored.
bool parted_by_axis(const WideBox& of, const WideBox& other, double error) noexcept {
  const Vec3 d = minus(other.center, of.center);
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = std::fabs(dot(d, of.axes[i]));
    if (along - of.half[i] - other.reach(of.axes[i]) > error) return true;
  }
  return false;
}

template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats>
ORCHARD_INLINE void find_gaps(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
                              BoxGaps& result) noexcept {
  const Boxes<Kind> p = Boxes<Kind>::of(single), q = Boxes<Kind>::of(lanes, scale);
  const BoxPair<Kind> pair(p, q);
  Floats gap = pair.ball_gap;
  const Floats by_line = pair.each_axis([&](const Floats& other, const typename E::Vectors&, const Floats&)
                                            ORCHARD_INLINE_LAMBDA { gap = E::max(gap, other); });
  const auto used = E::all(0.0f) <= E::at(lanes.radius);
  gap = Kind::choose(used, E::max(gap, by_line) - E::all(margin), E::all(std::numeric_limits<float>::infinity()));
  store(gap, result.gap);
  result.used = Kind::bits(used);
  result.meeting = Kind::bits(gap <= E::all(0.0f));
}

}  // namespace

bool boxes_are_apart(const NodeBox& first, const NodeBox& second, const Pose& relative) noexcept {
  const WideBox p(first), q(second, relative);
  // The error covers a few operations on the coordinates of the centres, and how far a rotation may be from a proper
  // one (kRigidTolerance), which turns the boxes.
  double error = 0x1p-36 * (p.radius + q.radius);
  for (std::size_t i = 0; i < 3; ++i) error += 0x1p-46 * (std::fabs(p.center[i]) + std::fabs(q.center[i]));
  return parted_by_axis(p, q, error) || parted_by_axis(q, p, error);
}

void box_gaps(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin, BoxGaps& result) noexcept {
  PerMachine<find_gaps<Widest>, find_gaps<Base>, find_gaps<PlainFloats>>::call(single, lanes, scale, margin, result);
}

}  // namespace orchard::runtime::detail
