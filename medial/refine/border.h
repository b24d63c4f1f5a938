#pragma once
#include "ball_complex.h"

namespace orchard::detail {

struct BorderOptions {
  double level = 0;        // mesh units: sheets end where what they lose beyond is this (BallSolver::loss)
  double tolerance = 0;    // mesh units: what a ball between two exact ones may protrude or fall short
  double spacing = 0;      // mesh units, of the surface points
  double sharp_angle = 0;  // radians between the normals of two faces at an edge that sheets reach to
};

// Fills the notches of the sheets' borders: a vertex between two border edges that see each other becomes an inner one,
// by a triangle, where there is a ball of the axis in the middle of its third side. Returns the number of triangles.
Index fill_notches(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options);

// Lets the sheets that end near a sharp convex edge reach it, by vertices of radius 0, where the balls in between are
// right up to the tolerance. Returns the number of new vertices, which come last.
Index extend_to_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options);

}  // namespace orchard::detail
