#pragma once
#include <array>
#include <vector>

#include "../balls/ball_complex.h"
#include "../features/feature_edges.h"

namespace orchard::detail {

struct BorderOptions {
  double level = 0;  // in mesh units: sheets end where the surface that they lose beyond is this far (BallSolver::loss)
  double tolerance = 0;  // in mesh units: by how much a ball between two exact ones may protrude or fall short
  double spacing = 0;    // mesh units, of the surface points
  double merging = 0;    // mesh units; see BallSolver
  const FeatureEdges* features = nullptr;  // the edges that sheets reach
};

// In tolerances: how far cells that are added at borders may be off. Cells that are slightly off are divided later.
inline constexpr double kBorderSlack = 4;

// The vertices and angles along edges that have exactly one triangle.
struct Borders {
  // The two neighbours of each vertex that has exactly two border edges on one sheet.
  std::vector<std::array<Index, 2>> next;
  std::vector<double> inner;  // the sum of the angles of the triangles at such a vertex, in radians
};

Borders find_borders(const BallComplex& complex);

// Returns the angle at one vertex between two others, in radians.
double angle_at(const BallComplex& complex, Index at, Index a, Index b);

}  // namespace orchard::detail
