#pragma once
#include <algorithm>
#include <span>

#include "../triangle_quality.h"
#include "sheet_mesh.h"

// Measures how well the triangles of a medial complex are shaped.
namespace orchard::detail {

double triangle_quality(const SheetMesh& mesh, const SheetMesh::Cell& cell);

// How flat a mesh is at the edges of triangles, as cosines: 1 is flat, and -1 is folded over. Where three or more
// triangles meet, the two that are nearest to each other count.
struct Flatness {
  double in_sheets = 1, at_seams = 1;

  // Whether no edge is folded over that was not before. Sheets may meet at any angle that the solid requires, except
  // that they must not lie on each other.
  bool keeps(const Flatness& before) const {
    return in_sheets >= std::min(before.in_sheets, kFlat) && at_seams >= std::min(before.at_seams, kApart);
  }

 private:
  static constexpr double kFlat = 0.3;    // 73 degrees
  static constexpr double kApart = -0.9;  // 26 degrees between two sheets
};

// The shape of some cells: the worst triangle among them, and the worst edges of these triangles.
struct TriangleShape {
  double quality = 1;  // see triangle_quality()
  Flatness flatness;
};
double worst_quality(const SheetMesh& mesh, std::span<const Index> cells);
Flatness worst_flatness(const SheetMesh& mesh, std::span<const Index> cells);
inline TriangleShape worst_shape(const SheetMesh& mesh, std::span<const Index> cells) {
  return {worst_quality(mesh, cells), worst_flatness(mesh, cells)};
}

}  // namespace orchard::detail
