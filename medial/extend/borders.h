#pragma once
#include <array>
#include <vector>

#include "../balls/ball_complex.h"
#include "../features/feature_edges.h"

namespace orchard::detail {

struct BorderOptions {
  double level = 0;      // mesh units: sheets end where what they lose beyond is this (BallSolver::loss)
  double tolerance = 0;  // mesh units: what a ball between two exact ones may protrude or fall short
  double spacing = 0;    // mesh units, of the surface points
  double merging = 0;    // mesh units; see BallSolver
  const FeatureEdges* features = nullptr;  // edges that sheets reach to
};

// Tolerances that cells added at borders may be off by: what is a little off is divided later.
inline constexpr double kBorderSlack = 4;

// What is at the ends of the edges of one triangle.
struct Borders {
  std::vector<std::array<Index, 2>> next;  // of each vertex with just two border edges on one sheet: its neighbours
  std::vector<double> inner;               // radians: the sum of the triangles' angles at such a vertex
};

Borders find_borders(const BallComplex& complex);

// Radians, at one vertex between two others.
double angle_at(const BallComplex& complex, Index at, Index a, Index b);

}  // namespace orchard::detail
