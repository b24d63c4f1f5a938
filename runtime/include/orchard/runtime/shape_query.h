#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// Simple shapes against one body. Coordinates, lengths and results are in the world's units. Answers are about the
// triangles as stored (see vertex_error) and correct to rounding in double, about 1e-14 of the coordinates. Nothing is
// allocated, nothing is thrown; trees are only read, so any number of threads may ask at once.
// Preconditions: structure_fault(tree) is nullptr and the tree has triangles. Where a pose does not satisfy is_rigid(),
// a number is not finite, or a place is more than kFarthest of the body's units away along an axis, the answer is the
// one that makes nobody miss a contact, and names no triangle: distance 0, a hit where the ray begins, "inside". Cost:
// O(log n) patches and a few dozen triangles where the surface is much larger than the distance asked for.
namespace orchard::runtime {

inline constexpr double kFarthest = 1e100;

// False where that is so: for telling such an answer from others.
bool can_ask(const TreeView& tree, const Pose& pose, const std::array<double, 3>& place) noexcept;

struct SurfacePoint {
  double distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> point{};  // of the surface
  std::uint32_t triangle = kNoTriangle;
};

// The surface point nearest to `center`, or to the segment from p to q, if it is no farther than `limit`; otherwise
// kNoTriangle and the distance is infinite. A sphere of radius r touches the surface iff nearest_point(.., r).distance
// <= r; so does a capsule.
SurfacePoint nearest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& center,
                           double limit = std::numeric_limits<double>::infinity()) noexcept;
SurfacePoint nearest_point_to_segment(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                                      const std::array<double, 3>& q,
                                      double limit = std::numeric_limits<double>::infinity()) noexcept;

struct RayHit {
  double along;  // hit = origin + along * direction
  std::array<double, 3> point;
  std::uint32_t triangle;  // kNoTriangle only where nothing could be asked
};

// The first triangle that origin + t * direction, 0 <= t <= longest, meets; direction of any length. Watertight: edges
// belong to both neighbours, decided exactly.
std::optional<RayHit> cast_ray(const TreeView& tree, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction,
                               double longest = std::numeric_limits<double>::infinity()) noexcept;

// Whether a point is inside the solid that the triangles bound (they must be closed and oriented outward): where they
// wind around it at least once, as everywhere in orchard. By signed crossings of a ray, exactly; by the sum of the
// triangles' angles where sixteen rays all meet an edge. Points of the surface may count either way.
bool contains(const TreeView& solid, const Pose& pose, const std::array<double, 3>& point) noexcept;

// The question that NarrowPhase leaves open: whether `inner` lies wholly inside `solid`. Precondition: their surfaces
// do not touch, and inner's surface is connected; so one of its points decides.
bool contains_solid(const TreeView& solid, const Pose& pose, const TreeView& inner, const Pose& inner_pose) noexcept;

}  // namespace orchard::runtime
