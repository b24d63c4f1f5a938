#pragma once
#include <span>

#include "sheet_mesh.h"

// How well the triangles of a medial complex are shaped.
namespace orchard::detail {

// 6 / sqrt(3) times the area over half the perimeter and the longest side: 1 if equilateral, 0 without area.
double triangle_quality(const Point& a, const Point& b, const Point& c);
double triangle_quality(const SheetMesh& mesh, const SheetMesh::Cell& cell);

// What cells are like: the worst triangle among them, and the worst edge of these triangles.
struct TriangleShape {
  double quality = 1;   // see triangle_quality()
  double flatness = 1;  // the cosine of what two triangles turn by at an edge: 1 flat, -1 folded; where sheets meet, of
                        // the two that are nearest to each other
};
double worst_quality(const SheetMesh& mesh, std::span<const Index> cells);
double worst_flatness(const SheetMesh& mesh, std::span<const Index> cells);
inline TriangleShape worst_shape(const SheetMesh& mesh, std::span<const Index> cells) {
  return {worst_quality(mesh, cells), worst_flatness(mesh, cells)};
}

}  // namespace orchard::detail
