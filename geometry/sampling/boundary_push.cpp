#include "boundary_push.h"

#include <algorithm>
#include <cmath>

namespace orchard::detail {

// The midpoint sums use only + - * / and roots, so that every machine computes the same table.
BoundaryPush::BoundaryPush() {
  constexpr int kParts = 64;
  const auto of_line_at = [](double t) {  // the integral over y of (1 - d) t / d, where d = |(t, y)| < 1
    const double half = std::sqrt(std::max(0.0, 1 - t * t));
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {
      // Steps that grow with y suit the peak at y = 0.
      const double s = (i + 0.5) / kParts, y = half * s * s, d = std::sqrt(t * t + y * y);
      sum += (1 - d) * (t / d) * (2 * s * half / kParts);
    }
    return 2 * sum;
  };
  for (int i = kSteps - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    line_[at] = i == 0 ? 0.0 : of_line_at(static_cast<double>(i) / kSteps);
    area_[at] = area_[at + 1];
    constexpr int kSlices = 8;
    for (int k = 0; k < kSlices; ++k) area_[at] += of_line_at((i + (k + 0.5) / kSlices) / kSteps) / (kSlices * kSteps);
  }
}

double BoundaryPush::interpolate(const Table& table, double t) {
  const double x = kSteps * std::clamp(t, 0.0, 1.0);
  const int i = static_cast<int>(x);
  const double part = x - i;
  const auto at = static_cast<std::size_t>(i);
  return table[at] + part * (table[at + 1] - table[at]);
}

}  // namespace orchard::detail
