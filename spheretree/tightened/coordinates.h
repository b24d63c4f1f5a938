#pragma once
#include <cstddef>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Points stored by coordinate, so that several are measured in one step.
struct Coordinates {
  static constexpr std::size_t kBlock = 128;  // the maximum number of points that one call measures

  std::vector<double> x, y, z;
  std::size_t size() const { return x.size(); }
  void push_back(const Point& point);
  // Calls visit(which, squared distance) for all points from number `first` on, ascending.
  template <typename Visit>
  void each_squared_distance(const Point& from, Visit&& visit, std::size_t first = 0) const {
    double squared[kBlock];
    for (std::size_t begin = first; begin < size(); begin += kBlock) {
      const std::size_t count = measure_block(begin, from, squared);
      for (std::size_t k = 0; k < count; ++k) visit(begin + k, squared[k]);
    }
  }
  // Writes the squared distances of the points from `begin` on. Returns how many there are.
  std::size_t measure_block(std::size_t begin, const Point& from, double* squared) const;
};

}  // namespace orchard::detail
