#include "tree/principal_axes.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::detail {

std::array<Vec3, 3> axes_of(const std::array<double, 6>& m) noexcept {
  double a[3][3] = {{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}};
  std::array<Vec3, 3> v = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  // the eigenvectors, as rows
  constexpr int sweeps = 8;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        if (!std::isfinite(t)) continue;
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
          const double vx = v[p][k], vy = v[q][k];
          v[p][k] = c * vx - s * vy, v[q][k] = s * vx + c * vy;
        }
      }
    }
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  // This sorts in place; std::stable_sort() may allocate memory.
  for (std::size_t i = 1; i < 3; ++i) {
    for (std::size_t k = i; k > 0 && a[order[k]][order[k]] > a[order[k - 1]][order[k - 1]]; --k)
      std::swap(order[k], order[k - 1]);
  }
  return {v[order[0]], v[order[1]], v[order[2]]};
}

}  // namespace orchard::runtime::detail
