#pragma once
#include <array>
#include <optional>

namespace orchard::runtime {

// Where a body is: world = rotation * body + translation. Rotation is row-major.
// Precondition of every query: `rotation` is a proper rotation to within kRigidTolerance (is_rigid()). Scaling, shear
// and mirroring are not supported: radii would be wrong, and so would a "no". A matrix integrated over many frames must
// be normalised by the caller, e.g. through a quaternion.
struct Pose {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 0};

  friend bool operator==(const Pose&, const Pose&) = default;
};

inline constexpr double kRigidTolerance = 1e-12;  // on every entry of rotation^T * rotation - identity

bool is_rigid(const Pose& pose) noexcept;  // false for entries that are not finite, too

// From a quaternion (w, x, y, z) of any length; nothing if it is zero or anything is not finite.
std::optional<Pose> pose_from_quaternion(const std::array<double, 4>& wxyz,
                                         const std::array<double, 3>& translation) noexcept;

Pose compose(const Pose& outer, const Pose& inner) noexcept;  // outer after inner
Pose inverse(const Pose& pose) noexcept;

std::array<double, 3> transform(const Pose& pose, const std::array<double, 3>& point) noexcept;
std::array<double, 3> rotate(const Pose& pose, const std::array<double, 3>& direction) noexcept;

}  // namespace orchard::runtime
