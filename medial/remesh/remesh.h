#pragma once
#include <span>

#include "../balls/ball_complex.h"
#include "../features/feature_edges.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

// Lengths in mesh units.
struct RemeshOptions {
  double max_length = 0;  // of edges: shorter where the axis bends, and along borders
  double min_length = 0;  // of edges that are aimed at
  double tolerance = 0;   // that interpolated balls may protrude or fall short by
  double limit = 0;       // how far places of the surface may be from the balls, or as far as they are before
  double merging = 0;     // see BallSolver
  const FeatureEdges* features = nullptr;  // the mesh's edges that sheets end on
  int rounds = 6;
};

// Makes the triangles of a medial complex even, at vertices for which `where` is not 0 and near them: edges that are
// long are split, short ones are drawn together, others flipped, and vertices moved along the sheet, seam, border or
// curve that they are in; every vertex is the centre of an exact ball where one is found. Topology stays, and what
// junctions, seams, borders and curves there are; nothing folds that did not, and what is covered of `places` on the
// surface stays covered. Deterministic. Returns how often a vertex was moved.
Index remesh(const Surface& surface, std::span<const Point> places, BallComplex& complex,
             std::span<const std::uint8_t> where, const RemeshOptions& options, const Progress& progress);

}  // namespace orchard::detail
