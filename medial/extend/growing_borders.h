#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "point_grid.h"
#include "sheet_extension.h"

namespace orchard::detail {

// The borders of sheets while triangles are added to them.
class GrowingBorders {
 public:
  // Starts with the present borders of the sheets. `reach` (mesh units) is the distance within which near() searches.
  // `sheets` must outlive this object. O(n) for n border edges.
  GrowingBorders(const SheetExtension& sheets, double reach);

  // Records a triangle that was added to the sheets.
  void add(Index a, Index b, Index c);

  // Returns whether an edge has exactly one triangle.
  bool has(const std::array<Index, 2>& edge) const;

  // Returns the edges with one triangle and an end within reach of a place, each with its nearer end first. They are in
  // ascending order of the length by which a triangle from the edge to the place would lengthen the borders.
  std::vector<std::array<Index, 2>> near(const Point& place) const;

 private:
  static std::uint64_t key(const std::array<Index, 2>& edge) {
    return std::uint64_t{std::min(edge[0], edge[1])} << 32 | std::max(edge[0], edge[1]);
  }
  void add_edge(const std::array<Index, 2>& edge);

  const SheetExtension& sheets_;
  double reach_;
  std::vector<std::array<Index, 2>> edges_;
  std::unordered_map<std::uint64_t, int> triangles_at_;  // the number of triangles of each edge
  PointGrid ends_;
};

}  // namespace orchard::detail
