#include "orchard/runtime/pose.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime {

bool is_rigid(const Pose& pose) noexcept {
  const auto& r = pose.rotation;
  if (!(pose.scale > 0 && std::isfinite(pose.scale))) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(pose.translation[i])) return false;
    for (std::size_t j = 0; j < 3; ++j) {
      const double product = r[i] * r[j] + r[3 + i] * r[3 + j] + r[6 + i] * r[6 + j];
      if (!(std::fabs(product - (i == j ? 1.0 : 0.0)) <= kRigidTolerance)) return false;
    }
  }
  const double determinant =
      r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]);
  return determinant > 0;
}

std::optional<Pose> pose_from_quaternion(const std::array<double, 4>& wxyz,
                                         const std::array<double, 3>& translation) noexcept {
  double largest = 0;
  for (const double q : wxyz) {
    if (!std::isfinite(q)) return std::nullopt;
    largest = std::max(largest, std::fabs(q));
  }
  for (const double t : translation) {
    if (!std::isfinite(t)) return std::nullopt;
  }
  if (largest == 0) return std::nullopt;

  // Dividing by the largest entry first keeps the squares away from overflow and underflow.
  std::array<double, 4> q{};
  double square = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = wxyz[i] / largest;
    square += q[i] * q[i];
  }
  for (double& entry : q) entry /= std::sqrt(square);
  const auto [w, x, y, z] = q;
  return Pose{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
               2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),  //
               2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
              translation};
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  Pose result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result.rotation[3 * i + j] = outer.rotation[3 * i] * inner.rotation[j] +
                                   outer.rotation[3 * i + 1] * inner.rotation[3 + j] +
                                   outer.rotation[3 * i + 2] * inner.rotation[6 + j];
    }
  }
  result.scale = outer.scale * inner.scale;
  result.translation = transform(outer, inner.translation);
  return result;
}

Pose inverse(const Pose& pose) noexcept {
  Pose result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result.rotation[3 * i + j] = pose.rotation[3 * j + i];
  }
  result.scale = 1 / pose.scale;
  result.translation = rotate(result, pose.translation);
  for (double& t : result.translation) t = 0 - t * result.scale;  // not -t: no negative zero for the identity
  return result;
}

}  // namespace orchard::runtime
