#include "weight_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "nearest_sample.h"

namespace orchard::detail {
namespace {

constexpr int kCells = 48;  // the number of cells along each side

struct Meets {
  const Box& cell;
  bool operator()(const Box& box) const { return box.intersects(cell); }
  bool operator()(const Sphere& ball) const {
    return cell.squaredExteriorDistance(ball.center) <= ball.radius * ball.radius;
  }
};

double factor_of(const std::vector<WeightRegion>& regions, const Box& cell) {
  double factor = 0;
  for (const WeightRegion& region : regions)
    if (std::visit(Meets{cell}, region.where)) factor = std::max(factor, region.factor);
  return factor > 0 ? factor : 1;
}

}  // namespace

WeightField::WeightField(const Surface& surface, const SetWeights& weights) : box_(surface.bounding_box()) {
  if (weights.empty()) return;
  const Vector step = box_.sizes() / kCells;
  const NearestSample vertices(weights.of_vertices.empty() ? std::vector<Point>() : surface.mesh().vertices);
  auto values = std::make_shared<std::vector<double>>(kCells * kCells * kCells);
  tbb::parallel_for(0, kCells * kCells * kCells, [&](int i) {
    const int x = i % kCells, y = i / kCells % kCells, z = i / (kCells * kCells);
    const Vector at(x, y, z);
    const Point low = box_.min() + step.cwiseProduct(at);
    double factor = factor_of(weights.regions, Box(low, Point(low + step)));
    const Point middle = low + step / 2;
    Index nearest = kNone;
    double least = std::numeric_limits<double>::infinity();
    vertices.visit(middle, least, [&](Index v) {
      const double distance = (vertices[v] - middle).norm();
      if (distance < least || (distance == least && v < nearest)) least = distance, nearest = v;
      return least;
    });
    if (nearest != kNone) factor *= weights.of_vertices[nearest];
    (*values)[static_cast<std::size_t>(i)] = factor;
  });
  values_ = std::move(values);
}

WeightField WeightField::in(const Box& box) const {
  WeightField field = *this;
  field.box_ = box;
  return field;
}

double WeightField::at(const Point& point) const {
  if (empty()) return 1;
  std::size_t index = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double side = box_.sizes()[axis];
    const double cell = side > 0 ? (point[axis] - box_.min()[axis]) / side * kCells : 0;
    index = index * kCells + static_cast<std::size_t>(std::clamp(cell, 0.0, kCells - 1.0));
  }
  return (*values_)[index];
}

}  // namespace orchard::detail
