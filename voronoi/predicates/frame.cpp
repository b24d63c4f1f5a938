#include "predicates/frame.h"

#include <cmath>

namespace orchard::detail {

Frame::Frame(const Box& box) {
  if (box.isEmpty()) return;
  const double max = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = (box.min()[axis] + box.max()[axis]) / 2, half = box.sizes()[axis] / 2;
    if (std::abs(middle) > 3 * half) origin_[axis] = middle;
  }
  const double size =
      std::max((box.min() - origin_).cwiseAbs().maxCoeff(), (box.max() - origin_).cwiseAbs().maxCoeff());
  if (size > 0) unit_ = std::ldexp(1.0, std::ilogb(size) - 1);
  rounding_ = 0x1p-53 * max / unit_;
}

}  // namespace orchard::detail
