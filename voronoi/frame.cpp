#include "frame.h"

#include <cmath>

#include "orchard/geometry/error.h"

namespace orchard::detail {

Frame::Frame(const Box& box) {
  if (box.isEmpty()) return;
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (largest > kLargest) throw InputError("a point has a coordinate above 1e100: scale the points down");
  const double extent = box.sizes().maxCoeff();
  if (extent > 0 && extent < kSmallest) throw InputError("the points are less than 1e-100 apart: scale them up");
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = (box.min()[axis] + box.max()[axis]) / 2, half = box.sizes()[axis] / 2;
    if (std::abs(middle) > 3 * half) origin_[axis] = middle;
  }
  const double size =
      std::max((box.min() - origin_).cwiseAbs().maxCoeff(), (box.max() - origin_).cwiseAbs().maxCoeff());
  if (size > 0) unit_ = std::ldexp(1.0, std::ilogb(size) - 1);
  rounding_ = 0x1p-53 * largest / unit_;
}

}  // namespace orchard::detail
