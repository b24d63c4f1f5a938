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

// Simple shapes against one body. Coordinates, lengths and results are in the world's units. Answers are about the
// triangles as stored (see vertex_error) and correct to rounding in double, about 1e-14 of the coordinates. Nothing is
// allocated, nothing is thrown; trees are only read, so any number of threads may ask at once.
// Preconditions: structure_fault(tree) is nullptr and the tree has triangles. Where a pose does not satisfy is_rigid(),
// a number is not finite, or a place is more than kFarthest of the body's units away along an axis, the answer is the
// one that misses no contact, and names no triangle: distance 0, a hit where the ray begins, "inside". Cost:
// O(log n) ball slabs and a few dozen triangles where the surface is much larger than the distance asked for.
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

// The same question as a boolean, for less: whether a capsule, the points within `radius` of the segment from p to q,
// touches the surface; a sphere if p is q. "Maybe" where nothing could be asked.
Answer touches_capsule(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                       const std::array<double, 3>& q, double radius) noexcept;

struct RayHit {
  double along;  // hit = origin + along * direction
  std::array<double, 3> point;
  std::uint32_t triangle;  // kNoTriangle only where nothing could be asked
};

// The first triangle that origin + t * direction, 0 <= t <= longest, meets; direction of any length. Watertight: edges
// belong to both neighbours, decided exactly. The line does not depend on `longest`: a hit that a ray without an end
// has at `along` comes, the same bit for bit, with every `longest` >= `along`.
std::optional<RayHit> cast_ray(const TreeView& tree, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction,
                               double longest = std::numeric_limits<double>::infinity()) noexcept;

// Many rays against one body: the same answers, and cheaper by what the pose costs each. hits.size() >= rays.size().
void cast_rays(const TreeView& tree, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept;

// The surface point that reaches deepest below a plane, normal . x = offset, the normal of any length but 0: `distance`
// is its signed distance from the plane, negative below it, and minus infinity, without a triangle, where nothing could
// be asked. The half-space normal . x <= offset touches the surface iff it is <= 0.
SurfacePoint deepest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& normal,
                           double offset) noexcept;

// A convex solid: the corners, and triangles outward, of positive area, all around it. At most kMaxCorners and
// kMaxFacets.
struct ConvexShape {
  std::span<const std::array<double, 3>> corners;
  std::span<const std::array<std::uint32_t, 3>> facets;
};
inline constexpr std::size_t kMaxCorners = 256, kMaxFacets = 508;

// Whether a convex solid, its inside included, and the surface have a point in common: exact for the triangles and
// facets as stored, with the solid moved into the body's frame in double. "Maybe" where nothing can be asked, for a
// solid with more corners or facets or a facet without area, and where a facet names a corner that does not exist.
struct ShapeContact {
  Answer answer = Answer::maybe;
  std::uint32_t triangle = kNoTriangle;  // of the surface, if the answer is yes
};
ShapeContact touches_convex(const TreeView& tree, const Pose& pose, const ConvexShape& shape,
                            const Pose& shape_pose) noexcept;
// A box around its pose's origin, of half the edges' lengths `half`, all positive.
ShapeContact touches_box(const TreeView& tree, const Pose& pose, const std::array<double, 3>& half,
                         const Pose& box_pose) noexcept;

// Whether a point is inside the solid that the triangles bound (they must be closed and oriented outward): where they
// wind around it at least once, as everywhere in orchard. By signed crossings of a ray, exactly; by the sum of the
// triangles' angles where sixteen rays all meet an edge. Points of the surface may count either way.
bool contains(const TreeView& solid, const Pose& pose, const std::array<double, 3>& point) noexcept;

// The surface point nearest to `center`, with a sign: `distance` is negative inside the solid, as contains() decides.
// `normal` is the unit vector in which the distance grows: out of the solid; on the surface the triangle's. Zero, and
// no triangle, where nothing could be asked or nothing is within `limit`. Precondition: as contains().
struct SignedPoint {
  SurfacePoint surface;
  std::array<double, 3> normal{};
};
SignedPoint signed_nearest_point(const TreeView& solid, const Pose& pose, const std::array<double, 3>& center,
                                 double limit = std::numeric_limits<double>::infinity()) noexcept;

// The question that NarrowPhase leaves open: whether `inner` lies wholly inside `solid`. Precondition: their surfaces
// do not touch, and inner's surface is connected; so one of its points decides.
bool contains_solid(const TreeView& solid, const Pose& pose, const TreeView& inner, const Pose& inner_pose) noexcept;

namespace detail {
struct RayIndexAccess;
}

struct BoxBlock;

// A second tree over a body's triangles, of boxes along the axes, for many rays against one body: cast_ray() and
// cast_rays() give the same answers with it as without, bit for bit, for about half of the time. It holds the triangles
// itself and refers to nothing afterwards; queries only read it, so any number of threads may ask at once.
class RayIndex {
 public:
  RayIndex() noexcept;  // no triangles: no ray hits
  // O(n log n) for n triangles, some 1.5 us a triangle, and about 60 bytes a triangle afterwards. Deterministic. Throws
  // std::bad_alloc only. Precondition: structure_fault(tree) is nullptr.
  explicit RayIndex(const TreeView& tree);

  RayIndex(const RayIndex&);
  RayIndex(RayIndex&&) noexcept;
  RayIndex& operator=(const RayIndex&);
  RayIndex& operator=(RayIndex&&) noexcept;
  ~RayIndex();

  bool empty() const noexcept { return leaves_.empty(); }
  std::size_t bytes() const noexcept;  // of memory, besides the object itself

 private:
  friend struct detail::RayIndexAccess;
  std::array<double, 3> origin_{}, middle_{};  // the tree's; the centre of a ball around the triangles
  double radius_ = 0, bounding_radius_ = 0;    // of that ball; the tree's
  std::vector<BoxBlock> boxes_;                // block 0 holds the children of the root
  std::vector<TriangleBlock> leaves_;
  std::vector<float> sizes_;  // of the leaves' boxes: the diagonals, rounded up
};

// As of the tree that the index was made of: see shape_query.h. Where the ray begins so far away that floats do not
// reach, more than 1e30 units, every triangle is looked at.
std::optional<RayHit> cast_ray(const RayIndex& index, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction,
                               double longest = std::numeric_limits<double>::infinity()) noexcept;
void cast_rays(const RayIndex& index, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept;

}  // namespace orchard::runtime
