#include "orchard/spheretree/outside_volume.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// Powers of 1 / 1.3247.., the root of x^3 = x + 1: the two-dimensional golden ratio (Roberts 2018).
constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
constexpr double kRaysPerCell = 2;

double fraction(double x) { return x - std::floor(x); }

struct Interval {
  double begin, end;
};
// Where a ray crosses the surface, and by how much the winding number rises there.
struct Crossing {
  double at;
  int rise;
};

// What each ray meets.
template <class Item>
class ByRay {
 public:
  explicit ByRay(std::size_t rays) : begin_(rays + 1, 0) {}
  void add(Index ray, const Item& item) {
    found_.push_back({ray, item});
    ++begin_[ray + 1];
  }

  // Once, when all is there: then rows can be looked at.
  template <class Before>
  void sort(const Before& before) {
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    items_.resize(found_.size());
    std::vector<Index> next(begin_.begin(), begin_.end() - 1);
    for (const auto& [ray, item] : found_) items_[next[ray]++] = item;
    for (std::size_t ray = 0; ray + 1 < begin_.size(); ++ray)
      std::sort(items_.begin() + begin_[ray], items_.begin() + begin_[ray + 1], before);
  }
  std::span<const Item> operator[](std::size_t ray) const {
    return {items_.data() + begin_[ray], items_.data() + begin_[ray + 1]};
  }

 private:
  std::vector<std::pair<Index, Item>> found_;
  std::vector<Index> begin_;
  std::vector<Item> items_;
};

// Rays along the z axis of a frame whose z axis is the longest of a box, sorted into cells across it.
class Rays {
 public:
  Rays(const Box& box, std::uint64_t count) : min_(Eigen::Vector2d::Zero()) {
    box.sizes().maxCoeff(&along_);
    min_ = across(box.min());
    const Eigen::Vector2d sizes = across(box.max()) - min_;
    area_ = sizes.prod();
    per_axis_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count) / kRaysPerCell)));
    cell_ = sizes / per_axis_;
    std::vector<Eigen::Vector2d> places;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double n = static_cast<double>(i);
      places.emplace_back(min_ +
                          sizes.cwiseProduct(Eigen::Vector2d(fraction(0.5 + n * kStepX), fraction(0.5 + n * kStepY))));
    }
    sort_into_cells(places);
  }

  std::size_t size() const { return places_.size(); }
  const Eigen::Vector2d& operator[](std::size_t ray) const { return places_[ray]; }
  double area() const { return area_; }
  Eigen::Vector2d across(const Point& p) const { return {p[(along_ + 1) % 3], p[(along_ + 2) % 3]}; }
  double along(const Point& p) const { return p[along_]; }

  // Calls visit(ray) for every ray in the rectangle, and some near it.
  template <class Visit>
  void for_each_near(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, const Visit& visit) const {
    const auto [x0, y0] = cell_of(lower);
    const auto [x1, y1] = cell_of(upper);
    for (int y = y0; y <= y1; ++y)
      for (Index ray = begin_[index(x0, y)]; ray < begin_[index(x1, y) + 1]; ++ray) visit(ray);
  }

 private:
  std::array<int, 2> cell_of(const Eigen::Vector2d& p) const {
    std::array<int, 2> cell{};
    for (int axis = 0; axis < 2; ++axis) {
      const double at = cell_[axis] > 0 ? (p[axis] - min_[axis]) / cell_[axis] : 0;
      cell[static_cast<std::size_t>(axis)] = static_cast<int>(std::clamp(at, 0.0, per_axis_ - 1.0));
    }
    return cell;
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(per_axis_) + static_cast<std::size_t>(x);
  }

  void sort_into_cells(const std::vector<Eigen::Vector2d>& places) {
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

  int along_ = 0;
  int per_axis_ = 1;
  double area_ = 0;
  Eigen::Vector2d min_, cell_;
  std::vector<Eigen::Vector2d> places_;
  std::vector<Index> begin_;  // of each cell among the rays
};

// Twice the area that a point spans with an edge, positive on its left. Both triangles at an edge get the same number,
// but for its sign, so no ray slips between them.
double left_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const bool turned = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
  const Eigen::Vector2d &from = turned ? b : a, &to = turned ? a : b;
  double area = (to.x() - from.x()) * (p.y() - from.y()) - (to.y() - from.y()) * (p.x() - from.x());
  if (area == 0) area = std::numeric_limits<double>::denorm_min();  // on the edge: left of it, whoever asks
  return turned ? -area : area;
}

void find_crossings(const Surface& surface, const Rays& rays, ByRay<Crossing>& found) {
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
      // Counter-clockwise from above is a triangle that faces up: the ray leaves there.
      found.add(ray, {at, a > 0 ? -1 : 1});
    });
  }
  found.sort([](const Crossing& x, const Crossing& y) { return x.at < y.at; });
}

void find_chords(std::span<const Sphere> balls, const Rays& rays, ByRay<Interval>& found) {
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

double length_inside(std::span<const Crossing> crossings, double begin, double end) {
  double length = 0;
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].rise;
    if (winding > 0) length += std::max(0.0, std::min(end, crossings[i + 1].at) - std::max(begin, crossings[i].at));
  }
  return length;
}

// What of the chords' union is outside.
double length_outside(std::span<const Interval> chords, std::span<const Crossing> crossings) {
  double length = 0;
  for (std::size_t i = 0; i < chords.size();) {
    Interval joined = chords[i++];
    for (; i < chords.size() && chords[i].begin <= joined.end; ++i) joined.end = std::max(joined.end, chords[i].end);
    length += joined.end - joined.begin - length_inside(crossings, joined.begin, joined.end);
  }
  return length;
}

}  // namespace

double outside_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t count) {
  if (!surface.solid()) throw InputError("the outside volume needs a closed surface; repair the mesh first");
  if (balls.empty() || count == 0) return 0;
  Box box;
  for (const Sphere& ball : balls) {
    box.extend(Point(ball.center - Vector::Constant(ball.radius)));
    box.extend(Point(ball.center + Vector::Constant(ball.radius)));
  }
  const Rays rays(box, count);
  ByRay<Crossing> through_surface(rays.size());
  ByRay<Interval> through_balls(rays.size());
  tbb::parallel_invoke([&] { find_crossings(surface, rays, through_surface); },
                       [&] { find_chords(balls, rays, through_balls); });
  double sum = 0;
  for (std::size_t ray = 0; ray < rays.size(); ++ray) sum += length_outside(through_balls[ray], through_surface[ray]);
  return rays.area() * sum / static_cast<double>(rays.size());
}

}  // namespace orchard
