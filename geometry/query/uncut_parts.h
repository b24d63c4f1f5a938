#pragma once
#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "triangle_tree.h"

namespace orchard::detail {

// The parts of a closed, oriented surface: connected parts that no other part cuts or touches. In front of a part,
// the winding number is the same everywhere. So if the triangles that may be nearest to a query agree, they decide
// whether it is inside. The proof is at the head of uncut_parts.cpp.
class UncutParts {
 public:
  // `cuts` is self_intersections(mesh). Keeps references to the arguments. Precondition: the mesh is closed,
  // consistently oriented and without degenerate triangles.
  UncutParts(const TriangleMesh& mesh, const TriangleTree& tree, std::span<const std::array<Index, 2>> cuts);

  // Returns whether the winding number at the query is above 1/2. `nearest` is the result of closest() for the query.
  // The answer is exact unless the query is on the surface. Many threads may call it at once.
  bool inside(const Point& query, const NearestTriangles& nearest) const;

 private:
  struct Vote {
    Index part;
    bool in_front;
  };
  std::optional<Vote> vote(const Point& query, const NearestTriangles& nearest) const;

  const TriangleMesh& mesh_;
  const TriangleTree& tree_;
  std::vector<Index> part_of_;                      // the part of each triangle; kNone if it is cut
  mutable std::vector<std::atomic<int>> in_front_;  // the winding number in front of each part, once it is known
};

}  // namespace orchard::detail
