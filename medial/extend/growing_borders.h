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
  // Of the sheets as they were; `reach` (mesh units) is how far from a place borders are looked for. `sheets` must
  // outlive it. O(n) for n border edges.
  GrowingBorders(const SheetExtension& sheets, double reach);

  // A triangle that has been added to the sheets.
  void add(Index a, Index b, Index c);

  // Whether an edge has just one triangle.
  bool has(const std::array<Index, 2>& edge) const;

  // The edges with one triangle and an end within reach of a place, the nearer end first: those before others from
  // which a triangle to the place makes the borders longer by less.
  std::vector<std::array<Index, 2>> near(const Point& place) const;

 private:
  static std::uint64_t key(const std::array<Index, 2>& edge) {
    return std::uint64_t{std::min(edge[0], edge[1])} << 32 | std::max(edge[0], edge[1]);
  }
  void add_edge(const std::array<Index, 2>& edge);

  const SheetExtension& sheets_;
  double reach_;
  std::vector<std::array<Index, 2>> edges_;
  std::unordered_map<std::uint64_t, int> triangles_at_;  // how many, of these edges
  PointGrid ends_;
};

}  // namespace orchard::detail
