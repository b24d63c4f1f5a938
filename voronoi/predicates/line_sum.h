#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The most that a straight line can collect of amounts, each at a place of its own: the cells of a grid that the
// place's box meets. A line passes through no more cells than it crosses planes of the grid, and one more; so what it
// collects is no more than what the fullest so many cells hold.
class LineSum {
 public:
  explicit LineSum(const Box& box);

  // An amount that a line collects at most once, in the triangle a, b, c.
  void add(double amount, const Point& a, const Point& b, const Point& c);
  double max() const;

 private:
  struct Item {
    double amount;
    std::array<std::uint8_t, 3> low, high;
  };

  Point origin_;
  double per_length_;
  std::vector<Item> items_;
};

}  // namespace orchard::detail
