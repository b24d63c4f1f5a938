#include "predicates/line_sum.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace orchard::detail {
namespace {

constexpr std::size_t kSide = 64;                 // cells along each axis
constexpr std::size_t kOnLine = 3 * kSide - 2;    // the number of cells that a line can pass through
constexpr std::size_t kMaxCells = kSide * kSide;  // of one place; an amount in more cells counts as being everywhere

}  // namespace

LineSum::LineSum(const Box& box) : origin_(box.min()), per_length_(kSide / box.sizes().maxCoeff()) {}

// The index of a cell never decreases as a coordinate grows, whatever is rounded. So the cell of any point of the
// triangle is between those of its corners.
void LineSum::add(double amount, const Point& a, const Point& b, const Point& c) {
  const Point low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  Item item{amount, {}, {}};
  const auto cell = [&](const Point& p, int axis) {
    const double along = (p[axis] - origin_[axis]) * per_length_;
    return static_cast<std::uint8_t>(std::clamp(along, 0.0, static_cast<double>(kSide - 1)));
  };
  for (int axis = 0; axis < 3; ++axis) {
    item.low[static_cast<std::size_t>(axis)] = cell(low, axis);
    item.high[static_cast<std::size_t>(axis)] = cell(high, axis);
  }
  items_.push_back(item);
}

double LineSum::max() const {
  double anywhere = 0;
  std::vector<double> cells(kSide * kSide * kSide, 0.0);
  for (const auto& [amount, low, high] : items_) {
    std::size_t count = 1;
    for (unsigned axis = 0; axis < 3; ++axis) count *= high[axis] - low[axis] + std::size_t{1};
    if (count > kMaxCells) {
      anywhere += amount;
      continue;
    }
    for (std::size_t x = low[0]; x <= high[0]; ++x)
      for (std::size_t y = low[1]; y <= high[1]; ++y)
        for (std::size_t z = low[2]; z <= high[2]; ++z) cells[(x * kSide + y) * kSide + z] += amount;
  }
  std::nth_element(cells.begin(), cells.begin() + kOnLine, cells.end(), std::greater<>());
  return std::accumulate(cells.begin(), cells.begin() + kOnLine, anywhere);
}

}  // namespace orchard::detail
