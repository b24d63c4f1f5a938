#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "../quality/reconstruction.h"

namespace orchard::detail {

// The cells that were found last. The next query is often near one of them, and testing all of them costs a tenth of a
// search.
class RecentCells {
 public:
  explicit RecentCells(const Reconstruction& reconstruction) : reconstruction_(reconstruction) {}

  void add(Index cell) {
    const auto end = cells_.begin() + static_cast<std::ptrdiff_t>(count_);
    auto at = std::find(cells_.begin(), end, cell);
    if (at == end) at = count_ < cells_.size() ? cells_.begin() + static_cast<std::ptrdiff_t>(count_++) : end - 1;
    *at = cell;
    std::rotate(cells_.begin(), at, at + 1);
  }
  // Whether one of the cells comes within `limit` of every point of the convex hull of `corners`. The distance to one
  // cell is a convex function, so testing the corners suffices.
  bool cover(std::span<const Point> corners, double limit) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!std::all_of(corners.begin(), corners.end(), [&](const Point& corner) {
            return reconstruction_.distance_to_cell(cells_[i], corner, limit) <= limit;
          }))
        continue;
      add(cells_[i]);
      return true;
    }
    return false;
  }
  // Returns the nearest of these cells.
  Reconstruction::Nearest nearest(const Point& query, double enough) const {
    Reconstruction::Nearest nearest;
    for (std::size_t i = 0; i < count_ && !(nearest.distance < enough); ++i) {
      const double distance = reconstruction_.distance_to_cell(cells_[i], query, nearest.distance);
      if (distance < nearest.distance) nearest = {.distance = distance, .ball = {}, .cell = cells_[i]};
    }
    return nearest;
  }

 private:
  const Reconstruction& reconstruction_;
  std::array<Index, 8> cells_{};  // the most recent one first
  std::size_t count_ = 0;
};

}  // namespace orchard::detail
