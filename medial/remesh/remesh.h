#pragma once
#include <span>

#include "../balls/ball_complex.h"
#include "../features/feature_edges.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

// Lengths in mesh units.
struct RemeshOptions {
  double max_length = 0;  // of edges; target lengths are shorter where the axis bends, and along borders
  double min_length = 0;  // the smallest target length
  double tolerance = 0;   // how far interpolated balls may protrude or fall short
  // The distance that places of the surface may have from the balls; those that are farther may stay that far.
  double limit = 0;
  double merging = 0;                      // see BallSolver
  const FeatureEdges* features = nullptr;  // the edges of the mesh that sheets end on
  int rounds = 6;
};

// Makes the triangles of a medial complex even, at and near the vertices for which `where` is not 0. It splits long
// edges, collapses short ones, flips others, and moves vertices along the sheet, seam, border or curve that they lie
// in. Each vertex gets an exact ball if one is found. The topology stays, as do the junctions, seams, borders and
// curves. No triangle folds over that did not before, and the part of `places` on the surface that is covered stays
// covered. Deterministic. Returns the number of moves of vertices.
Index remesh(const Surface& surface, std::span<const Point> places, BallComplex& complex,
             std::span<const std::uint8_t> where, const RemeshOptions& options, const Progress& progress);

}  // namespace orchard::detail
