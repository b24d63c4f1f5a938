#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "orchard/geometry/surface.h"

// Computes volumes by parallel rays. The part of a ray inside a solid, or inside a union of balls, is known exactly, so
// only the two directions across the rays are sampled.
namespace orchard::detail {

// A part of a ray.
struct Interval {
  double begin, end;
};
// Where a ray crosses the surface, and by how much the winding number rises there.
struct Crossing {
  double at;
  int rise;
};

// The items that each ray meets.
template <class Item>
class ByRay {
 public:
  explicit ByRay(std::size_t rays) : begin_(rays + 1, 0) {}
  void add(Index ray, const Item& item) {
    found_.push_back({ray, item});
    ++begin_[ray + 1];
  }

  // Sorts the items. Call it once, after all have been added and before rows are read.
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
class ParallelRays {
 public:
  // `shift` is the offset of the sequence, in [0, 1) along each axis. Different offsets give independent estimates.
  ParallelRays(const Box& box, std::uint64_t count, const Eigen::Vector2d& shift = {0.5, 0.5});

  std::size_t size() const { return places_.size(); }
  const Eigen::Vector2d& operator[](std::size_t ray) const { return places_[ray]; }
  double area() const { return area_; }
  Eigen::Vector2d across(const Point& p) const { return {p[(along_ + 1) % 3], p[(along_ + 2) % 3]}; }
  double along(const Point& p) const { return p[along_]; }
  // Returns the two axes across the rays, in the order of across(), and the one along them.
  std::array<int, 3> axes() const { return {(along_ + 1) % 3, (along_ + 2) % 3, along_}; }

  // Calls visit(ray) for every ray in the rectangle, and for some near it.
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

  void sort_into_cells(const std::vector<Eigen::Vector2d>& places);

  int along_ = 0;
  int per_axis_ = 1;
  double area_ = 0;
  Eigen::Vector2d min_, cell_;
  std::vector<Eigen::Vector2d> places_;
  std::vector<Index> begin_;  // where the rays of each cell begin
};

// Finds the crossings of each ray with the surface and with the balls, sorted along the ray.
void find_crossings(const Surface& surface, const ParallelRays& rays, ByRay<Crossing>& found);
void find_chords(std::span<const Sphere> balls, const ParallelRays& rays, ByRay<Interval>& found);

}  // namespace orchard::detail
