#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "orchard/runtime/ray.h"
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime {

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
