#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"

namespace orchard {

// How the axis that the Voronoi diagram approximates becomes one of exact balls.
struct RefineOptions {
  // Where a sheet ends, in diagonals of the bounding box: what the axis loses beyond a border is no more than this,
  // r (1 / cos(a / 2) - 1) for a ball of radius r whose contacts are seen at an angle a. At least 0.
  double border_loss = 1e-3;
  // In diagonals: how far a ball that is interpolated on an edge or a triangle may protrude from the solid or fall
  // short of its surface before the cell is divided. Above 0.
  double tolerance = 5e-4;
  // Radians between the normals of two faces from which sheets reach to the convex edge between them, in [0, pi].
  double sharp_angle = 0.7;
  // Of dividing cells; each halves them. At least 0.
  int max_rounds = 6;
  // Of reaching for what is left open of the surface. At least 0.
  int reach_rounds = 9;
  // What the points can show, in squares of their spacing over the diagonal, as what a chord cuts off a curve is: what
  // is left open by less is not reached for. With 5,000 points it is about the border loss. At least 0: anything.
  double reach_detail = 7;
};

// What refining did.
struct RefineReport {
  Index vertices_before = 0, vertices = 0;
  Index inexact = 0;           // vertices that stayed where they were: no ball with two contacts was found from there
  Index folded_triangles = 0;  // taken away: their two points have one contact
  Index border_cuts = 0;       // edges cut where the loss passes border_loss
  Index small_pieces = 0;      // edges and triangles of spikes and flakes, taken away
  Index doubled = 0;           // triangles of sheets that double others, taken away
  Index notches = 0;           // triangles that fill notches of borders, and what is open along sharp edges
  Index edge_vertices = 0;     // vertices of radius 0 on sharp edges
  Index reached_places = 0;    // of the surface, left open by more than borders may
  Index divided = 0;           // edges
  Index undivided = 0;         // edges beyond the tolerance that are left, as short as they get or after max_rounds
  Index degenerate = 0;        // vertices merged with others at their place, and flat triangles taken away
  double border_length = 0;    // in diagonals, of the result
};

struct RefinedAxis {
  // With triangles for faces, and no walls. Its points are the contacts of its vertices, each with one to four; those
  // of a face are the two contacts of its corners that are seen farthest apart. Vertices of radius 0 are on sharp
  // edges. So validate(axis, surface) does not hold.
  MedialAxis axis;
  RefineReport report;
};

// The refined axis: every vertex is moved to the centre of a ball of the medial axis of the mesh itself, which touches
// the surface where the forming points stand for and holds nothing of it, or, inside a sheet where none is found or one
// that stands out, to such a ball between its neighbours; cells that fold onto others are taken away; sheets are cut
// where their borders lose border_loss; spikes and flakes go that hang on the rest by one vertex and reach no farther
// from it than twice its radius, but for what the topology needs; notches between the teeth of their borders are
// filled, those that end at sharp convex edges are extended onto these, and what is open between such ends on one edge
// is filled; sheets and spikes go whose balls lie in others up to the tolerance, where the borders become shorter by
// that, and flakes that one edge joins to others, before anything is reached for; the steps of borders from one facet
// of the surface to the next are filled; what is interpolated too coarsely is divided, with exact balls for new
// vertices; where the surface is then left open by more than 1.65 border_loss and reach_detail, or balls leave a dent
// that is a tenth deeper, triangles reach for it from the nearest edges; and at last vertices at one place are merged,
// and triangles without area taken away, or given some by moving a vertex along its sheet. All by divisions, collapses,
// free extensions and contractions under the link condition, so the topology is that of `axis`.
//
// Vertices have the radius that is the distance of their centre to the surface, up to rounding. Deterministic;
// parallel. O(n log n) for n vertices, and some nearest-point queries each. `sampling` has the points of `axis`. Throws
// InputError unless surface.solid(), or if an option is out of range.
RefinedAxis refine_axis(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis,
                        const RefineOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
