#pragma once
#include "../balls/split.h"
#include "borders.h"
#include "orchard/geometry/surface.h"

// What makes sheets go as far as they belong. All of it is free: it changes no topology.
namespace orchard::detail {

// Which notches are filled.
struct NotchLimits {
  double max_angle = 0;   // radians: wider ones are none
  double max_bend = 0;    // radians: by which the angle across may differ from what the sheet leaves of a full one
  double max_length = 0;  // spacings: the third side of a triangle that fills one
  double min_loss = 0;    // of the level: of the ball in the middle of that side
  // Whether triangles are divided on trial (SplitOptions): only what is right then is filled, and what is right as it
  // is with balls that are not exact.
  bool on_trial = false;
};

// Fills the notches of the sheets' borders: a vertex between two border edges that see each other becomes an inner one,
// by a triangle, where there is a ball of the axis near the middle of its third side. Returns the number of triangles.
Index fill_notches(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options,
                   const SplitOptions& dividing, const NotchLimits& limits);

// Lets the sheets between two parallel faces, thinner than the points' spacing, go on to the seam where a third face
// comes as near. Returns the number of new triangles.
Index extend_to_seams(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Lets the sheets that end near a sharp convex edge reach it, by vertices of radius 0, where the balls in between are
// right up to the tolerance; and adds those between a seam and such an edge that are missing, being narrower than the
// points' spacing. Returns the number of new vertices.
Index extend_to_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Lets the sheets that reach sharp convex edges go on to the corner where the edges meet. Returns the number of new
// vertices.
Index extend_to_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options);

// Fills sheets between places next to each other on feature edges, where thin parts of the solid leave them in strips,
// or seams end there. Returns the number of new triangles.
Index fill_along_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options);

}  // namespace orchard::detail
