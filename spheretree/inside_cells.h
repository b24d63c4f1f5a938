#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Answers as surface.inside() does, for many points: cells of the bounding box that lie wholly inside or outside are
// known beforehand, since the signed distance of their centre exceeds their half diagonal. Precondition:
// surface.solid(), which the surface outlives.
class InsideCells {
 public:
  // 2^depth cells along each axis; costs a distance for each cell near the surface.
  InsideCells(const Surface& surface, int depth);
  bool inside(const Point& point) const;

 private:
  enum class Side : std::uint8_t { outside, inside, both };
  void fill(const std::array<int, 3>& first, int cells);
  std::size_t index(int x, int y, int z) const { return static_cast<std::size_t>((z * per_axis_ + y) * per_axis_ + x); }

  const Surface& surface_;
  int per_axis_;
  Vector cell_;  // its sides
  std::vector<Side> side_;
};

}  // namespace orchard::detail
