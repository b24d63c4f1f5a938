#pragma once
#include <array>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"

// Refines the axis that a Voronoi diagram approximates into one whose vertices are exact medial balls of the mesh.
namespace orchard {

// The options of refine_axis(). Lengths are fractions of the diagonal of the bounding box.
struct RefineOptions {
  // The loss at which a sheet ends, at least 0. A ball of radius r whose contacts are seen from its centre at an angle
  // a loses r (1 / cos(a / 2) - 1), and the axis loses at most border_loss beyond a border. Smaller values let the
  // sheets reach farther towards edges and need more triangles.
  double border_loss = 1e-3;
  // The error at which a cell is divided, above 0: how far a ball that is interpolated on an edge or a triangle may
  // protrude from the solid or fall short of its surface. Smaller values give more triangles.
  double tolerance = 5e-4;
  // Sheets reach to a convex edge of the mesh if its loss without them is at least feature_loss (above 0), and if it
  // belongs to a chain of such edges that is at least feature_length long (at least 0). The loss of an edge is its
  // distance from the largest ball that touches both of its faces. The default feature_loss is the amount by which
  // borders may leave the surface open.
  double feature_loss = 1.65e-3, feature_length = 0.2;
  // The edges that sheets reach, each as two vertices of the mesh. If this is empty, they are found by their loss.
  std::vector<std::array<Index, 2>> features = {};
  // The target length of edges, above 0: an edge of the result is at most 4/3 as long. Edges become shorter where
  // interpolation would be off by more than the tolerance, and at borders with small balls.
  double edge_length = 0.03;
  // The maximum number of rounds of dividing cells, at least 0. Each round halves the cells that are off by more than
  // the tolerance.
  int max_rounds = 6;
  // The maximum number of rounds of reaching for places where the surface is left open, at least 0.
  int reach_rounds = 9;
  // The detail that the surface points can show, at least 0, as a multiple of the square of their spacing over the
  // diagonal, as the depth of a chord's arc is. Places left open by less are not reached for; 0 reaches for all. With
  // 5,000 points and the default, this is about the border loss.
  double reach_detail = 7;
};

// Counts of what refine_axis() did.
struct RefineReport {
  Index vertices_before = 0, vertices = 0;
  Index inexact = 0;           // Vertices that were not moved, since no ball with two contacts was found from there.
  Index folded_triangles = 0;  // Triangles removed because their two points have the same contact.
  Index border_cuts = 0;       // Edges cut where the loss passes border_loss.
  Index small_pieces = 0;      // Edges and triangles of spikes and flakes that were removed.
  Index vertices_moved = 0;    // Moves of vertices by smoothing; a vertex counts each time it is moved.
  Index notches = 0;           // Triangles added to fill notches of borders and openings along sharp edges.
  Index edge_vertices = 0;     // Vertices of radius 0 on sharp edges.
  Index reached_places = 0;    // Places of the surface that were left open by more than borders may leave open.
  Index divided = 0;           // Edges that were divided.
  Index undivided = 0;   // Edges beyond the tolerance that remain because they are too short or max_rounds is used up.
  Index degenerate = 0;  // Vertices merged with others at the same place, and flat triangles removed.
  double border_length = 0;  // The length of the borders of the result, over the diagonal.
};

// The result of refine_axis().
struct RefinedAxis {
  // The refined axis. Its faces are triangles, and it has no walls. Its points are the contacts of its vertices, one to
  // four for each vertex. The two points of a face are the two contacts of its corners that are seen farthest apart.
  // Vertices of radius 0 lie on sharp edges, so validate(axis, surface) does not hold.
  MedialAxis axis;
  // The edges of the mesh that sheets reach, each as two vertices of the mesh, in ascending order.
  std::vector<std::array<Index, 2>> features;
  RefineReport report;
};

// Refines a medial axis in these steps:
// 1. Each vertex is moved to the centre of a ball of the medial axis of the mesh itself. The ball touches the surface
//    at the parts that the forming points stand for, and no part of the surface lies inside it. Cells that fold onto
//    others are removed.
// 2. Sheets are cut where their borders lose border_loss, and extended to the feature edges of the mesh and their
//    corners.
// 3. The triangles are remeshed to even sizes without uncovering the surface: edges are split, collapsed and flipped,
//    and each vertex moves along its sheet, seam, border or curve to an exact ball.
// 4. Where the surface is left open by more than 1.65 border_loss and reach_detail, or where balls leave a dent that is
//    a tenth deeper, triangles are added from the nearest edges and remeshed.
// 5. Cells whose interpolated balls are off by more than the tolerance are divided.
// All steps are divisions, collapses, flips, free extensions and contractions under the link condition, so the topology
// is that of `axis`.
//
// `sampling` holds the points of `axis`. In the result, the radius of a vertex is the distance from its centre to the
// surface, up to rounding. Throws InputError unless surface.solid(), or if an option is out of range. Takes O(n log n)
// for n vertices, and several nearest-point queries for each vertex. The result is deterministic; the work is parallel.
RefinedAxis refine_axis(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis,
                        const RefineOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
