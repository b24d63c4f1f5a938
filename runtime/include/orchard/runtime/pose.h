#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

// Vectors, poses and rays of the run-time.
namespace orchard::runtime {

// Three numbers along x, y and z. It is a type of its own, so that its operators are found in every namespace. It
// converts implicitly from and to std::array<double, 3>, which poses and contacts use.
struct Vec3 : std::array<double, 3> {
  constexpr Vec3() noexcept : std::array<double, 3>{} {}
  constexpr Vec3(double x, double y, double z) noexcept : std::array<double, 3>{x, y, z} {}
  constexpr Vec3(const std::array<double, 3>& v) noexcept : std::array<double, 3>(v) {}  // NOLINT: implicit
};

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) noexcept { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
constexpr Vec3 operator-(const Vec3& a) noexcept { return {-a[0], -a[1], -a[2]}; }
constexpr Vec3 operator*(double s, const Vec3& a) noexcept { return {s * a[0], s * a[1], s * a[2]}; }
constexpr double dot(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length(const Vec3& a) noexcept { return std::sqrt(dot(a, a)); }

// The place of a body in the world: world = scale * rotation * body + translation. The rotation is row-major.
// Every query tests is_rigid() first. For a pose that is not rigid (zeros, a mirror, shear, scales that differ between
// axes, NaN, or a rotation whose entries were rounded to float), its answer is that nothing is known: "maybe" without
// bounds, or what each function names. Otherwise radii, and so a "no", would be wrong. Use made_rigid() or
// pose_from_matrix() to repair rotations that were kept in floats or integrated over many frames.
struct Pose {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 0};
  double scale = 1;  // The uniform scale.

  friend bool operator==(const Pose&, const Pose&) = default;
};

// The tolerance of is_rigid() for a rotation with rows a, b, c. It applies to the root of the sum of the squares of
// |a|^2 - 1, |b|^2 - 1, a . b and the components of c - a x b.
inline constexpr double kRigidTolerance = 1e-12;
inline constexpr double kScaleLimit = 1e100;         // A scale is between 1 / kScaleLimit and kScaleLimit.
inline constexpr double kMaxRelativeScale = 0x1p44;  // Of one body of a pair to the other.
inline constexpr double kRepairTolerance = 1e-3;     // As kRigidTolerance, for made_rigid().

// Returns whether queries can answer for a pose: the rotation is proper to within kRigidTolerance, the scale is within
// its limits, and all numbers are finite. Takes about ten nanoseconds; queries call it themselves.
bool is_rigid(const Pose& pose) noexcept;

// Returns the pose with the nearest rotation for which is_rigid() holds, and the same translation and scale. Use it for
// matrices of floats and for products of many rotations. It moves no point of a body of radius R farther than rounding
// has moved it before: about 1e-7 R for floats. Returns nullopt if the matrix is farther than kRepairTolerance from a
// proper rotation, or if anything else is wrong. Takes about 100 ns.
std::optional<Pose> made_rigid(const Pose& pose) noexcept;
std::optional<Pose> pose_from_matrix(const std::array<float, 9>& rotation, const std::array<float, 3>& translation,
                                     float scale = 1) noexcept;

// Returns the pose of a quaternion (w, x, y, z) of any length other than 0. Returns nullopt if it is zero or a number
// is not finite.
std::optional<Pose> pose_from_quaternion(const std::array<double, 4>& wxyz,
                                         const std::array<double, 3>& translation) noexcept;

Pose compose(const Pose& outer, const Pose& inner) noexcept;  // Applies `inner` first, then `outer`.
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

// The points origin + t direction with 0 <= t <= longest. The direction may have any length but 0.
struct Ray {
  std::array<double, 3> origin{}, direction{};
  double longest = std::numeric_limits<double>::infinity();
};

}  // namespace orchard::runtime
