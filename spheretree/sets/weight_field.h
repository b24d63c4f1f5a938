#pragma once
#include <memory>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/set_weights.h"

namespace orchard::detail {

// Weights on a grid over a box. Outside the box, the weight is that of the nearest place on its border. Copies share
// the grid.
class WeightField {
 public:
  WeightField() = default;  // 1 everywhere
  WeightField(const Surface& surface, const SetWeights& weights);

  // Returns the weights for a surface that is moved and scaled so that its bounding box becomes `box`.
  WeightField in(const Box& box) const;
  double at(const Point& point) const;
  bool empty() const { return values_ == nullptr; }

 private:
  Box box_;
  std::shared_ptr<const std::vector<double>> values_;
};

}  // namespace orchard::detail
