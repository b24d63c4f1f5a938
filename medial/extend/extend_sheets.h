#pragma once
#include "../balls/split.h"
#include "borders.h"
#include "orchard/geometry/surface.h"

// Extends sheets as far as the solid requires. All of these changes keep the topology of the complex.
namespace orchard::detail {

// The conditions under which a notch is filled.
struct NotchLimits {
  double max_angle = 0;  // in radians: a wider angle is no notch
  // In radians: the angle across the notch may differ by this from a full turn minus the angle of the sheet.
  double max_bend = 0;
  double max_length = 0;  // in spacings: the largest third side of a triangle that fills a notch
  double min_loss = 0;    // over the level: the smallest loss of the ball in the middle of the third side
  // Whether triangles are divided on trial first (SplitOptions). Then only triangles that are right after division are
  // filled, and those of inexact balls only if they are right undivided.
  bool on_trial = false;
};

// Fills the notches of the borders of sheets. A vertex between two border edges that face each other becomes an inner
// vertex by adding a triangle, if there is a ball of the axis near the middle of the triangle's third side. Returns the
// number of triangles.
Index fill_notches(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options,
                   const SplitOptions& dividing, const NotchLimits& limits);

// Extends sheets between two parallel faces that are nearer to each other than the point spacing, up to the seam where
// a third face is as near. Returns the number of new triangles.
Index extend_to_seams(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Extends sheets that end near a sharp convex edge up to that edge, by vertices of radius 0, if the balls in between
// are right within the tolerance. It also adds sheets between a seam and such an edge that are missing because they are
// narrower than the point spacing. Returns the number of new vertices.
Index extend_to_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Divides borders that pass a corner in which three or more feature edges meet, at the corner. The sheet to the third
// edge can then end at the line in which it meets the other sheets, up to the corner; without a vertex there, it would
// get a border of its own beside that line. Returns the number of divided edges.
Index divide_at_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Extends sheets that reach sharp convex edges up to the corner where the edges meet. Returns the number of new
// vertices.
Index extend_to_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Fills sheets between adjacent places on feature edges. Thin parts of the solid leave such sheets in strips, and seams
// end there. Returns the number of new triangles.
Index fill_along_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options);

}  // namespace orchard::detail
