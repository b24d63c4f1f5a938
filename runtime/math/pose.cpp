#include "orchard/runtime/pose.h"

#include <algorithm>
#include <cmath>

#include "math/rigid_pair.h"

namespace orchard::runtime {

namespace {

constexpr int kMaxRepairs = 8;  // each squares the defect, 1e-3 at first

double defect_of(const std::array<double, 9>& rotation) noexcept {
  return detail::rotation_defect<double>([&rotation](std::size_t i) { return rotation[i]; });
}

// One step of Newton and Schulz towards the nearest orthogonal matrix: X (3 I - X^T X) / 2.
std::array<double, 9> nearer_rotation(const std::array<double, 9>& x) noexcept {
  std::array<double, 9> factor{}, result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double product = x[i] * x[j] + x[3 + i] * x[3 + j] + x[6 + i] * x[6 + j];
      factor[3 * i + j] = ((i == j ? 3.0 : 0.0) - product) / 2;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) result[3 * i + j] += x[3 * i + k] * factor[3 * k + j];
    }
  }
  return result;
}

}  // namespace

bool is_rigid(const Pose& pose) noexcept {
  for (const double t : pose.translation) {
    if (!std::isfinite(t)) return false;
  }
  return detail::rotates(pose);
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
