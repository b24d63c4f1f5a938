#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/vector_functions.h"
#include "orchard/runtime/time_of_impact.h"

namespace orchard::runtime {

using detail::along;
using detail::Matrix;
using detail::minus;

namespace {

// Returns the rotation about v by the angle |v| (Rodrigues' formula).
Matrix rotation_by(const Vec3& v) noexcept {
  const double angle = std::sqrt(dot(v, v));
  if (!(angle > 0)) return {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Vec3 k = along({0, 0, 0}, v, 1 / angle);
  const double s = std::sin(angle), half = std::sin(angle / 2), c = 2 * half * half;  // 1 - cos
  return {
      1 - c * (k[1] * k[1] + k[2] * k[2]), c * k[0] * k[1] - s * k[2],          c * k[0] * k[2] + s * k[1],
      c * k[0] * k[1] + s * k[2],          1 - c * (k[0] * k[0] + k[2] * k[2]), c * k[1] * k[2] - s * k[0],
      c * k[0] * k[2] - s * k[1],          c * k[1] * k[2] + s * k[0],          1 - c * (k[0] * k[0] + k[1] * k[1])};
}

// Returns the axis of a rotation times its angle, which is from 0 to pi.
Vec3 rotation_vector(const Matrix& r) noexcept {
  const Vec3 twice_sine = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
  const double sine = std::sqrt(dot(twice_sine, twice_sine)) / 2, cosine = (r[0] + r[4] + r[8] - 1) / 2;
  const double angle = std::atan2(sine, cosine);
  if (sine > 1e-4) return along({0, 0, 0}, twice_sine, angle / (2 * sine));
  if (cosine > 0) return along({0, 0, 0}, twice_sine, 0.5);
  // The rotation is nearly half a turn. R + R^T = 2 cos I + 2 (1 - cos) k k^T, so every column of (1 - cos) k k^T is
  // parallel to the axis k; the longest one is the most accurate.
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (r[4 * i] > r[4 * largest]) largest = i;
  }
  Vec3 k{};
  for (std::size_t i = 0; i < 3; ++i) {
    k[i] = (r[3 * largest + i] + r[3 * i + largest]) / 2 - (i == largest ? cosine : 0);
  }
  const double size = std::sqrt(dot(k, k)), sign = dot(k, twice_sine) < 0 ? -1 : 1;
  return along({0, 0, 0}, k, sign * angle / size);
}

}  // namespace

Pose Travel::at(double time) const noexcept {
  if (pose_at != nullptr) return pose_at(context, time);
  Pose pose = start;
  pose.rotation = detail::product(rotation_by(along({0, 0, 0}, spin, time)), start.rotation);
  if (is_rigid(start) && !is_rigid(pose)) pose = made_rigid(pose).value_or(pose);  // for the sum of roundings
  const Vec3 place = along(transform(start, center), velocity, time), arm = rotate(pose, center);
  pose.translation = along(place, arm, -pose.scale);
  return pose;
}

Travel travel_between(const Pose& from, const Pose& to, const std::array<double, 3>& center) noexcept {
  return {.start = from,
          .velocity = minus(transform(to, center), transform(from, center)),
          .spin = rotation_vector(detail::product(to.rotation, detail::transposed(from.rotation))),
          .center = center};
}

}  // namespace orchard::runtime
