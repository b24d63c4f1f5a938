#pragma once
#include <array>

namespace orchard::detail {

// What points beyond a straight boundary, thought of as spread evenly, do to a point at distance h inside when each
// repels it by 1 - d / r: the mean field that takes the place of neighbours which are not relaxed together.
class BoundaryPush {
 public:
  BoundaryPush();
  // Times the density of points per area, times r^2. At h = 0 it is 1/3.
  double of_area(double h_over_r) const { return interpolate(area_, h_over_r); }
  // Of points on the boundary itself; times their density per length, times r.
  double of_line(double h_over_r) const { return interpolate(line_, h_over_r); }

 private:
  static constexpr int kSteps = 64;
  using Table = std::array<double, kSteps + 2>;
  static double interpolate(const Table& table, double t);
  Table area_{}, line_{};
};

}  // namespace orchard::detail
