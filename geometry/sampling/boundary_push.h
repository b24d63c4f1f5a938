#pragma once
#include <array>

namespace orchard::detail {

// The force of points beyond a straight boundary on a point at distance h inside, if they are spread evenly and each
// repels it by 1 - d / r. It replaces neighbours that are not relaxed together with the point.
class BoundaryPush {
 public:
  BoundaryPush();
  // The force of points beyond the boundary; multiply it by their density per area and by r^2. At h = 0 it is 1/3.
  double of_area(double h_over_r) const { return interpolate(area_, h_over_r); }
  // The force of points on the boundary; multiply it by their density per length and by r.
  double of_line(double h_over_r) const { return interpolate(line_, h_over_r); }

 private:
  static constexpr int kSteps = 64;
  using Table = std::array<double, kSteps + 2>;
  static double interpolate(const Table& table, double t);
  Table area_{}, line_{};
};

}  // namespace orchard::detail
