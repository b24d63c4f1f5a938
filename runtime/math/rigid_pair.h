#pragma once
#include "orchard/runtime/pose.h"
#include "simd/vector_support.h"

// Tests whether poses are rigid. Every query begins with this, and many end soon after, so two poses are tested side by
// side.
namespace orchard::runtime::detail {

#ifdef ORCHARD_VECTORS
using Two __attribute__((vector_size(16))) = double;
#else
using Two = Several<double, 2>;
#endif

// Returns how far a matrix is from a proper rotation: how far the first two rows are from unit vectors perpendicular to
// each other, and the third one from their cross product, as a sum of squares. The result is not a number, or infinite,
// if an entry is. `T` is double or a vector of doubles.
template <typename T, typename At>
ORCHARD_INLINE T rotation_defect(At&& r) noexcept {
  const T a0 = r(0), a1 = r(1), a2 = r(2), b0 = r(3), b1 = r(4), b2 = r(5);
  const T one = spread<T>(1.0);
  const T a = a0 * a0 + a1 * a1 + a2 * a2 - one, b = b0 * b0 + b1 * b1 + b2 * b2 - one;
  const T across = a0 * b0 + a1 * b1 + a2 * b2;
  const T x = a1 * b2 - a2 * b1 - r(6), y = a2 * b0 - a0 * b2 - r(7), z = a0 * b1 - a1 * b0 - r(8);
  return (a * a + b * b + across * across) + (x * x + y * y + z * z);
}

inline constexpr double kMaxRotationDefect = kRigidTolerance * kRigidTolerance;

// Two poses, with the numbers of both side by side.
struct PoseLanes {
  Two rotation[9], translation[3], scale;

  ORCHARD_INLINE PoseLanes(const Pose& p, const Pose& q) noexcept {
    for (std::size_t i = 0; i < 9; ++i) rotation[i] = Two{p.rotation[i], q.rotation[i]};
    for (std::size_t i = 0; i < 3; ++i) translation[i] = Two{p.translation[i], q.translation[i]};
    scale = Two{p.scale, q.scale};
  }
  // Returns whether is_rigid() holds for both, except that translations are not tested.
  ORCHARD_INLINE bool rotate() const noexcept {
    const Two defect = rotation_defect<Two>([this](std::size_t i) ORCHARD_INLINE_LAMBDA -> Two { return rotation[i]; });
    const auto good = (defect <= spread<Two>(kMaxRotationDefect)) & (spread<Two>(1 / kScaleLimit) <= scale) &
                      (scale <= spread<Two>(kScaleLimit));
    return (good[0] & good[1]) != 0;
  }
  // Returns component i of the points, each moved by its pose. The operations and their order are those of transform().
  ORCHARD_INLINE Two placed(std::size_t i, const Two (&point)[3]) const noexcept {
    const Two turned = rotation[3 * i] * point[0] + rotation[3 * i + 1] * point[1] + rotation[3 * i + 2] * point[2];
    return scale * turned + translation[i];
  }
};

}  // namespace orchard::runtime::detail
