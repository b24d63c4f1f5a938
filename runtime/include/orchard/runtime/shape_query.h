#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// Queries of simple shapes against one body. Coordinates, lengths and results are in the world's units. Answers refer
// to the stored triangles (see vertex_error) and are correct to rounding in double, about 1e-14 of the coordinates.
// Nothing allocates or throws; trees are only read, so any number of threads may query at once.
// Preconditions: structure_fault(tree) is nullptr and the tree has triangles. If a pose does not satisfy is_rigid(), a
// number is not finite, or a place is more than kFarthest of the body's units away along an axis, the answer is the one
// that misses no contact, and names no triangle: distance 0, a hit where the ray begins, "inside". Cost: O(log n) ball
// slabs and a few dozen triangles if the surface is much larger than the distance of the query.
namespace orchard::runtime {

// The largest coordinate of a query, in the body's units.
inline constexpr double kFarthest = 1e100;

// Returns whether a query can be answered. It returns false in the cases above. Use it to find out whether an answer is
// only the one that misses no contact.
bool can_ask(const TreeView& tree, const Pose& pose, const std::array<double, 3>& place) noexcept;

// A point of a surface.
struct SurfacePoint {
  double distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> point{};  // The point on the surface.
  std::uint32_t triangle = kNoTriangle;
};

// Returns the surface point that is nearest to `center` or to the segment from p to q, if it is at most `limit` away;
// otherwise kNoTriangle and an infinite distance. A sphere of radius r touches the surface iff nearest_point(..,
// r).distance <= r, and so does a capsule.
SurfacePoint nearest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& center,
                           double limit = std::numeric_limits<double>::infinity()) noexcept;
SurfacePoint nearest_point_to_segment(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                                      const std::array<double, 3>& q,
                                      double limit = std::numeric_limits<double>::infinity()) noexcept;

// Returns whether a capsule, the points within `radius` of the segment from p to q, touches the surface; it is a sphere
// if p is q. This costs less than the distance. "Maybe" if the query cannot be answered.
Answer touches_capsule(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                       const std::array<double, 3>& q, double radius) noexcept;

// A hit of a ray.
struct RayHit {
  double along;  // hit = origin + along * direction.
  std::array<double, 3> point;
  std::uint32_t triangle;  // kNoTriangle only if the query cannot be answered.
};

// Returns the first triangle that origin + t * direction meets, 0 <= t <= longest. The direction may have any length.
// The result is watertight: edges belong to both neighbours, decided exactly. The line does not depend on `longest`: a
// hit at `along` of an infinite ray is the same, bit for bit, for every `longest` >= `along`.
std::optional<RayHit> cast_ray(const TreeView& tree, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction,
                               double longest = std::numeric_limits<double>::infinity()) noexcept;

// Casts many rays against one body. The hits are those of cast_ray(), and the pose is prepared only once. Precondition:
// hits.size() >= rays.size().
void cast_rays(const TreeView& tree, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept;

// Returns the surface point that is deepest below a plane, normal . x = offset, with a normal of any length but 0.
// `distance` is its signed distance from the plane, negative below it; it is minus infinity, without a triangle, if the
// query cannot be answered. The half-space normal . x <= offset touches the surface iff the distance is <= 0.
SurfacePoint deepest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& normal,
                           double offset) noexcept;

// A convex solid: its corners, and triangles of positive area around it, oriented outward. There are at most
// kMaxCorners and kMaxFacets.
struct ConvexShape {
  std::span<const std::array<double, 3>> corners;
  std::span<const std::array<std::uint32_t, 3>> facets;
};
inline constexpr std::size_t kMaxCorners = 256, kMaxFacets = 508;

// The result of touches_convex() and touches_box().
struct ShapeContact {
  Answer answer = Answer::maybe;
  std::uint32_t triangle = kNoTriangle;  // The triangle of the surface, for "yes".
};
// Returns whether a convex solid, its inside included, and the surface have a common point. The result is exact for the
// stored triangles and facets, with the solid moved into the body's frame in double. "Maybe" if the query cannot be
// answered, if the solid has more corners or facets than allowed or a facet without area, or if a facet names a corner
// that does not exist.
ShapeContact touches_convex(const TreeView& tree, const Pose& pose, const ConvexShape& shape,
                            const Pose& shape_pose) noexcept;
// Returns the same for a box around the origin of its pose. `half` contains half the edges' lengths, above 0.
ShapeContact touches_box(const TreeView& tree, const Pose& pose, const std::array<double, 3>& half,
                         const Pose& box_pose) noexcept;

// Returns whether a point is inside the solid that the triangles bound, which must be closed and oriented outward:
// whether they wind around it at least once, as everywhere in orchard. Signed crossings of a ray decide exactly; if
// sixteen rays all meet an edge, the sum of the triangles' angles decides. Points of the surface may count either way.
bool contains(const TreeView& solid, const Pose& pose, const std::array<double, 3>& point) noexcept;

// A surface point with a sign: `distance` is negative inside the solid, as contains() decides. `normal` is the unit
// vector in which the distance grows, out of the solid; on the surface it is that of the triangle. It is zero, without
// a triangle, if the query cannot be answered or no point is within the limit.
struct SignedPoint {
  SurfacePoint surface;
  std::array<double, 3> normal{};
};
// Returns the surface point that is nearest to `center`, if it is at most `limit` away. Precondition: as for
// contains().
SignedPoint signed_nearest_point(const TreeView& solid, const Pose& pose, const std::array<double, 3>& center,
                                 double limit = std::numeric_limits<double>::infinity()) noexcept;

// Returns whether `inner` lies wholly inside `solid`, which NarrowPhase does not answer. Precondition: the surfaces do
// not touch, and inner's surface is connected, so that one of its points decides.
bool contains_solid(const TreeView& solid, const Pose& pose, const TreeView& inner, const Pose& inner_pose) noexcept;

namespace detail {
struct IndexTriangles;
}

struct BoxBlock;

// A second tree over a body's triangles, of axis-aligned boxes, for many rays against one body: cast_ray() and
// cast_rays() give the same hits with it, bit for bit, in about half of the time. It contains copies of the triangles
// and refers to nothing after construction. Queries only read it, so any number of threads may use it at once.
class RayIndex {
 public:
  RayIndex() noexcept;  // Without triangles: no ray hits.
  // Builds the index of a tree. Precondition: structure_fault(tree) is nullptr. Throws std::bad_alloc only. The result
  // is deterministic. O(n log n) for n triangles, about 3 us for each, and about 65 bytes for each afterwards.
  explicit RayIndex(const TreeView& tree);

  RayIndex(const RayIndex&);
  RayIndex(RayIndex&&) noexcept;
  RayIndex& operator=(const RayIndex&);
  RayIndex& operator=(RayIndex&&) noexcept;
  ~RayIndex();

  bool empty() const noexcept { return leaves_.empty(); }
  std::size_t bytes() const noexcept;  // Of memory, in addition to the object itself.

 private:
  friend struct detail::IndexTriangles;
  std::array<double, 3> origin_{}, middle_{};  // Of the tree; the centre of a ball around the triangles.
  double radius_ = 0, bounding_radius_ = 0;    // Of that ball; of the tree.
  std::vector<BoxBlock> boxes_;                // Block 0 contains the root alone, block 1 its children.
  std::vector<TriangleBlock> leaves_;
  std::vector<float> sizes_;  // The diagonals of the leaves' boxes, rounded up.
};

// Casts rays with the same hits as for the tree from which the index was built. If a ray begins more than 1e30 units
// away, which floats cannot represent well, every triangle is tested.
std::optional<RayHit> cast_ray(const RayIndex& index, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction,
                               double longest = std::numeric_limits<double>::infinity()) noexcept;
void cast_rays(const RayIndex& index, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept;

}  // namespace orchard::runtime
