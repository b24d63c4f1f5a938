#pragma once
#include <array>
#include <vector>

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
  // In diagonals: sheets reach to the convex edges of the mesh that would lose so much, or more, if none did: an edge
  // lies so far outside the largest ball that touches both of its faces. By default as much as borders may leave open.
  // They come in chains that are as long as feature_length, or longer. Above 0; at least 0.
  double feature_loss = 1.65e-3, feature_length = 0.2;
  // The edges that sheets reach to, by the mesh's vertices; none: those that are found by their loss.
  std::vector<std::array<Index, 2>> features = {};
  // In diagonals: edges of the result are no longer than 4/3 of it, but where the surface asks for it shorter: where
  // what is interpolated would be off by more than the tolerance, and at borders with small balls. Above 0.
  double edge_length = 0.03;
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
  Index vertices_moved = 0;    // by evening out, each as often as it was
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
  std::vector<std::array<Index, 2>> features;  // edges of the mesh that sheets reach to, by its vertices, ascending
  RefineReport report;
};

// The refined axis: every vertex is moved to the centre of a ball of the medial axis of the mesh itself, which touches
// the surface where the forming points stand for and holds nothing of it; cells that fold onto others are taken away;
// sheets are cut where their borders lose border_loss, and reach the feature edges of the mesh and their corners. Then
// the triangles are made even (edges are split, drawn together and flipped, vertices move along their
// sheet, seam, border or curve, each to an exact ball), so that nothing is uncovered; where the surface is left open by
// more than 1.65 border_loss and reach_detail, or balls leave a dent that is a tenth deeper, triangles reach for it
// from the nearest edges, and are made even, too; and what is interpolated too coarsely is divided. All by divisions,
// collapses, flips, free extensions and contractions under the link condition, so the topology is that of `axis`.
//
// Vertices have the radius that is the distance of their centre to the surface, up to rounding. Deterministic;
// parallel. O(n log n) for n vertices, and some nearest-point queries each. `sampling` has the points of `axis`. Throws
// InputError unless surface.solid(), or if an option is out of range.
RefinedAxis refine_axis(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis,
                        const RefineOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
