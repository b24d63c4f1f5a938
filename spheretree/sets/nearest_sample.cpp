#include "nearest_sample.h"

#include <algorithm>
#include <numeric>

namespace orchard::detail {

NearestSample::NearestSample(std::vector<Point> points)
    : points_(std::move(points)), order_(points_.size()), splits_(points_.size()) {
  std::iota(order_.begin(), order_.end(), Index{0});
  divide(0, static_cast<Index>(points_.size()));
}

void NearestSample::divide(Index begin, Index end) {
  if (end - begin <= kLeaf) return;
  Box box;
  for (Index i = begin; i < end; ++i) box.extend(points_[order_[i]]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](Index a, Index b) {
    return points_[a][axis] < points_[b][axis] || (points_[a][axis] == points_[b][axis] && a < b);
  });
  splits_[middle] = {axis, points_[order_[middle]][axis]};
  divide(begin, middle);
  divide(middle, end);
}

}  // namespace orchard::detail
