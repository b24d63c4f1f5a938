#pragma once
#include <array>
#include <optional>

namespace orchard::runtime {

// Where an instance of a body is: world = scale * rotation * body + translation. Rotation is row-major.
// Precondition of every query: `rotation` is a proper rotation to within kRigidTolerance and `scale` is positive and
// finite (is_rigid()). Scales that differ between axes, shear and mirroring are not supported: radii would be wrong,
// and so would a "no". A matrix integrated over many frames must be normalised by the caller, e.g. through a
// quaternion.
struct Pose {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 0};
  double scale = 1;  // uniform

  friend bool operator==(const Pose&, const Pose&) = default;
};

inline constexpr double kRigidTolerance = 1e-12;  // on every entry of rotation^T * rotation - identity

bool is_rigid(const Pose& pose) noexcept;  // but for its scale; false for entries that are not finite, too

// From a quaternion (w, x, y, z) of any length; nothing if it is zero or anything is not finite.
std::optional<Pose> pose_from_quaternion(const std::array<double, 4>& wxyz,
                                         const std::array<double, 3>& translation) noexcept;

Pose compose(const Pose& outer, const Pose& inner) noexcept;  // outer after inner
Pose inverse(const Pose& pose) noexcept;

inline std::array<double, 3> rotate(const Pose& pose, const std::array<double, 3>& v) noexcept {
  const auto& r = pose.rotation;
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

inline std::array<double, 3> transform(const Pose& pose, const std::array<double, 3>& point) noexcept {
  const auto v = rotate(pose, point);
  return {pose.scale * v[0] + pose.translation[0], pose.scale * v[1] + pose.translation[1],
          pose.scale * v[2] + pose.translation[2]};
}

}  // namespace orchard::runtime
