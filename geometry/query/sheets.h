#pragma once
#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "triangle_tree.h"

namespace orchard::detail {

// The parts of a closed, oriented surface that nothing cuts or touches: next to such a sheet, on its front, the winding
// number is one and the same. So the triangles that may be nearest to a query tell whether it is inside, where they
// agree: the argument heads sheets.cpp.
class Sheets {
 public:
  // `cuts`: self_intersections(mesh). Keeps references. Precondition: the mesh is closed, consistently oriented and
  // without degenerate triangles.
  Sheets(const TriangleMesh& mesh, const TriangleTree& tree, std::span<const std::array<Index, 2>> cuts);

  // Whether the winding number at the query is above 1/2. `nearest`: what closest() found for it. Exact wherever the
  // query is not on the surface. Safe to call from many threads: they learn the same.
  bool inside(const Point& query, const NearestTriangles& nearest) const;

 private:
  struct Vote {
    Index sheet;
    bool in_front;
  };
  std::optional<Vote> vote(const Point& query, const NearestTriangles& nearest) const;

  const TriangleMesh& mesh_;
  const TriangleTree& tree_;
  std::vector<Index> sheet_of_;                     // of each triangle; kNone if it is cut
  mutable std::vector<std::atomic<int>> in_front_;  // winding number in front of each sheet, once a query has told it
};

}  // namespace orchard::detail
