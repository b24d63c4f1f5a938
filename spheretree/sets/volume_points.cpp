#include "volume_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "golden_steps.h"

namespace orchard::detail {
namespace {

constexpr double kPointsPerCell = 6;
// The maximum number of points in the box over the number wanted inside, for solids that are thin in their box.
constexpr double kMostPerInside = 12;

double squared(double x) { return x * x; }

}  // namespace

VolumePoints::VolumePoints(const Surface& surface, std::size_t inside, double margin, const WeightField& weights)
    : box_(surface.bounding_box()) {
  const double room = margin * box_.sizes().maxCoeff();
  box_.min() -= Vector::Constant(room);
  box_.max() += Vector::Constant(room);
  const double share = std::max(1 / kMostPerInside, surface.report().volume / box_.volume());
  const auto count = static_cast<std::size_t>(static_cast<double>(inside) / share);
  std::vector<Point> points(count);
  std::vector<char> is_inside(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    points[i] = box_.min() + box_.sizes().cwiseProduct(golden_place(static_cast<double>(i)));
    is_inside[i] = surface.bounding_box().contains(points[i]) && surface.winding_number(points[i]) > 0;
  });
  sort_into_cells(points, is_inside);
  held_.assign(count, 0);
  worth_.resize(count);
  weights_.resize(count);
  for (std::size_t i = 0; i < count; ++i) weights_[i] = weights.at(Point(x_[i], y_[i], z_[i]));
  set_outside_weight(1);
  inside_count_ = static_cast<std::size_t>(std::count(inside_.begin(), inside_.end(), 1));
}

void VolumePoints::set_outside_weight(double weight) {
  for (std::size_t i = 0; i < worth_.size(); ++i) worth_[i] = weights_[i] * (inside_[i] != 0 ? 1 : -weight);
}

void VolumePoints::sort_into_cells(const std::vector<Point>& points, const std::vector<char>& inside) {
  cell_ = std::cbrt(box_.volume() * kPointsPerCell / static_cast<double>(std::max<std::size_t>(1, points.size())));
  for (int axis = 0; axis < 3; ++axis)
    cells_[static_cast<std::size_t>(axis)] = std::max(1, static_cast<int>(box_.sizes()[axis] / cell_) + 1);
  const auto cell_of = [&](const Point& p) {
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis)
      at[static_cast<std::size_t>(axis)] = std::clamp(static_cast<int>((p[axis] - box_.min()[axis]) / cell_), 0,
                                                      cells_[static_cast<std::size_t>(axis)] - 1);
    return cell_at(at[0], at[1], at[2]);
  };
  begin_.assign(cell_at(0, 0, cells_[2]) + 1, 0);
  for (const Point& p : points) ++begin_[cell_of(p) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<Index> next(begin_.begin(), begin_.end() - 1);
  x_.resize(points.size()), y_.resize(points.size()), z_.resize(points.size()), inside_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Index at = next[cell_of(points[i])]++;
    x_[at] = points[i].x(), y_[at] = points[i].y(), z_[at] = points[i].z(), inside_[at] = inside[i];
  }
}

// Calls visit(point) for the points in the cells that the box meets.
template <class Visit>
void VolumePoints::for_each_near(const Box& box, const Visit& visit) const {
  std::array<int, 3> low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const auto cell_at = [&](double at) {
      return static_cast<int>(std::clamp(std::floor((at - box_.min()[axis]) / cell_), 0.0, cells_[k] - 1.0));
    };
    low[k] = cell_at(box.min()[axis]);
    high[k] = cell_at(box.max()[axis]);
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y) {
      const auto row = cell_at(0, y, z);
      const Index end = begin_[row + static_cast<std::size_t>(high[0]) + 1];
      for (Index i = begin_[row + static_cast<std::size_t>(low[0])]; i < end; ++i) visit(i);
    }
}

namespace {

Box box_around(const Sphere& ball) {
  return {Point(ball.center - Vector::Constant(ball.radius)), Point(ball.center + Vector::Constant(ball.radius))};
}

}  // namespace

bool VolumePoints::is_in(const Sphere& ball, Index i) const {
  return squared(x_[i] - ball.center.x()) + squared(y_[i] - ball.center.y()) + squared(z_[i] - ball.center.z()) <=
         ball.radius * ball.radius;
}

// Returns the worth of those points in a ball that exactly `holders` balls of the set contain.
double VolumePoints::worth_in(const Sphere& ball, std::uint16_t holders) const {
  double worth = 0;
  for_each_near(box_around(ball), [&](Index i) {
    if (held_[i] == holders && is_in(ball, i)) worth += worth_[i];
  });
  return worth;
}

double VolumePoints::gain_of_change(const Sphere& from, const Sphere& to) const {
  double gain = 0;
  for_each_near(box_around(from).merged(box_around(to)), [&](Index i) {
    if (held_[i] > 1) return;
    const bool was = is_in(from, i);
    if (held_[i] == 1 && !was) return;  // it is contained in another ball
    const bool is = is_in(to, i);
    if (was != is) gain += is ? worth_[i] : -worth_[i];
  });
  return gain;
}

void VolumePoints::count(const Sphere& ball, int change) {
  for_each_near(box_around(ball), [&](Index i) {
    if (!is_in(ball, i)) return;
    const bool before = held_[i] > 0;
    held_[i] = static_cast<std::uint16_t>(held_[i] + change);
    const bool after = held_[i] > 0;
    if (before == after) return;
    std::size_t& all = inside_[i] != 0 ? inside_held_ : outside_held_;
    after ? ++all : --all;
  });
}

}  // namespace orchard::detail
