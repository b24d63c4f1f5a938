#include "parallel_rays.h"

#include <limits>

#include "golden_steps.h"

namespace orchard::detail {
namespace {

constexpr double kRaysPerCell = 2;

// Returns twice the area of the triangle of a point and an edge, positive on the left of the edge. Both triangles at an
// edge get the same number with opposite signs, so no ray passes between them.
double left_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const bool turned = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
  const Eigen::Vector2d &from = turned ? b : a, &to = turned ? a : b;
  double area = (to.x() - from.x()) * (p.y() - from.y()) - (to.y() - from.y()) * (p.x() - from.x());
  if (area == 0) area = std::numeric_limits<double>::denorm_min();  // a point on the edge counts as left of it
  return turned ? -area : area;
}

}  // namespace

ParallelRays::ParallelRays(const Box& box, std::uint64_t count, const Eigen::Vector2d& shift)
    : min_(Eigen::Vector2d::Zero()) {
  box.sizes().maxCoeff(&along_);
  min_ = across(box.min());
  const Eigen::Vector2d sizes = across(box.max()) - min_;
  area_ = sizes.prod();
  per_axis_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count) / kRaysPerCell)));
  cell_ = sizes / per_axis_;
  std::vector<Eigen::Vector2d> places;
  for (std::uint64_t i = 0; i < count; ++i)
    places.emplace_back(min_ + sizes.cwiseProduct(golden_place(shift, static_cast<double>(i))));
  sort_into_cells(places);
}

void ParallelRays::sort_into_cells(const std::vector<Eigen::Vector2d>& places) {
  begin_.assign(index(0, per_axis_) + 1, 0);
  const auto cell = [&](const Eigen::Vector2d& p) {
    const auto [x, y] = cell_of(p);
    return index(x, y);
  };
  for (const auto& p : places) ++begin_[cell(p) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  places_.resize(places.size());
  std::vector<Index> next(begin_.begin(), begin_.end() - 1);
  for (const auto& p : places) places_[next[cell(p)]++] = p;
}

void find_crossings(const Surface& surface, const ParallelRays& rays, ByRay<Crossing>& found) {
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto corners = surface.corners(t);
    const std::array<Eigen::Vector2d, 3> flat{rays.across(corners[0]), rays.across(corners[1]),
                                              rays.across(corners[2])};
    const Eigen::Vector2d lower = flat[0].cwiseMin(flat[1]).cwiseMin(flat[2]);
    const Eigen::Vector2d upper = flat[0].cwiseMax(flat[1]).cwiseMax(flat[2]);
    rays.for_each_near(lower, upper, [&](Index ray) {
      const double a = left_of(flat[1], flat[2], rays[ray]), b = left_of(flat[2], flat[0], rays[ray]),
                   c = left_of(flat[0], flat[1], rays[ray]);
      if ((a > 0) != (b > 0) || (a > 0) != (c > 0)) return;
      const double at =
          (a * rays.along(corners[0]) + b * rays.along(corners[1]) + c * rays.along(corners[2])) / (a + b + c);
      // A triangle that is counter-clockwise from above faces up, so the ray leaves the solid there.
      found.add(ray, {at, a > 0 ? -1 : 1});
    });
  }
  found.sort([](const Crossing& x, const Crossing& y) { return x.at < y.at; });
}

void find_chords(std::span<const Sphere> balls, const ParallelRays& rays, ByRay<Interval>& found) {
  for (const Sphere& ball : balls) {
    const Eigen::Vector2d center = rays.across(ball.center), reach = Eigen::Vector2d::Constant(ball.radius);
    rays.for_each_near(center - reach, center + reach, [&](Index ray) {
      const double squared = ball.radius * ball.radius - (rays[ray] - center).squaredNorm();
      if (squared <= 0) return;
      const double half = std::sqrt(squared), at = rays.along(ball.center);
      found.add(ray, {at - half, at + half});
    });
  }
  found.sort([](const Interval& x, const Interval& y) { return x.begin < y.begin; });
}

}  // namespace orchard::detail
