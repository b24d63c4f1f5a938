#include "orchard/runtime/pose.h"

#include <algorithm>
#include <cmath>

#include "math/rigid_pair.h"
#include "math/vector_functions.h"

namespace orchard::runtime {

namespace {

constexpr int kMaxRepairs = 8;  // each squares the defect, 1e-3 at first

double defect_of(const std::array<double, 9>& rotation) noexcept {
  return detail::rotation_defect<double>([&rotation](std::size_t i) { return rotation[i]; });
}

// Takes one step of the Newton-Schulz iteration towards the nearest orthogonal matrix: X (3 I - X^T X) / 2.
detail::Matrix nearer_rotation(const detail::Matrix& x) noexcept {
  detail::Matrix factor = detail::product(detail::transposed(x), x);
  for (std::size_t i = 0; i < 9; ++i) factor[i] = ((i % 4 == 0 ? 3.0 : 0.0) - factor[i]) / 2;
  return detail::product(x, factor);
}

}  // namespace

bool is_rigid(const Pose& pose) noexcept {
  for (const double t : pose.translation) {
    if (!std::isfinite(t)) return false;
  }
  const bool in_range = pose.scale >= 1 / kScaleLimit && pose.scale <= kScaleLimit;
  return in_range && defect_of(pose.rotation) <= detail::kMaxRotationDefect;
}

std::optional<Pose> made_rigid(const Pose& pose) noexcept {
  Pose result = pose;
  if (!(defect_of(pose.rotation) <= kRepairTolerance * kRepairTolerance)) return std::nullopt;
  constexpr double enough = 1e-15;
  for (int i = 0; i < kMaxRepairs && defect_of(result.rotation) > enough * enough; ++i) {
    result.rotation = nearer_rotation(result.rotation);
  }
  if (!is_rigid(result)) return std::nullopt;
  return result;
}

std::optional<Pose> pose_from_matrix(const std::array<float, 9>& rotation, const std::array<float, 3>& translation,
                                     float scale) noexcept {
  Pose pose;
  std::copy(rotation.begin(), rotation.end(), pose.rotation.begin());
  std::copy(translation.begin(), translation.end(), pose.translation.begin());
  pose.scale = double{scale};
  return made_rigid(pose);
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
  return {detail::product(outer.rotation, inner.rotation), transform(outer, inner.translation),
          outer.scale * inner.scale};
}

Pose inverse(const Pose& pose) noexcept {
  Pose result{.rotation = detail::transposed(pose.rotation), .scale = 1 / pose.scale};
  result.translation = rotate(result, pose.translation);
  for (double& t : result.translation) t = 0 - t * result.scale;  // not -t: no negative zero for the identity
  return result;
}

}  // namespace orchard::runtime
