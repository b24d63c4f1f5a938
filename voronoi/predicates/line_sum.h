#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// An upper bound on the sum of amounts that a straight line can meet, where each amount is at a place of its own: in
// the cells of a grid that the place's box meets. The number of cells that a line passes through is at most one more
// than the number of grid planes that it crosses. So its sum is at most that of as many of the fullest cells.
class LineSum {
 public:
  explicit LineSum(const Box& box);

  // Adds an amount that a line collects at most once, in the triangle a, b, c.
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
