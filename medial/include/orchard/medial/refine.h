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
  // Select the convex edges of the mesh that sheets reach: those whose loss is at least feature_loss (above 0), if they
  // form a chain with a length of at least feature_length (at least 0). The loss of an edge is its distance from the
  // largest ball that touches both of its faces; without a sheet, the axis leaves that much of the solid open. The
  // default feature_loss is 1.65 times the default border_loss, by which borders may leave the surface open.
  double feature_loss = 1.65e-3, feature_length = 0.2;
  // The edges that sheets reach, each as two vertices of the mesh. If this is empty, they are found by their loss.
  std::vector<std::array<Index, 2>> features = {};
  // The target length of edges, above 0: an edge of the result is at most 4/3 as long. Edges become shorter where
  // interpolation would be off by more than the tolerance, and at borders with small balls.
  double edge_length = 0.03;
  // The maximum number of rounds of dividing cells, at least 0. Each round halves the cells that are off by more than
  // the tolerance.
  int max_rounds = 6;
  // The maximum number of rounds of step 4 of refine_axis(), which adds triangles where the surface is left open; at
  // least 0.
  int reach_rounds = 9;
  // The limit of detail, at least 0. Step 4 ignores places that are left open by less than reach_detail s^2 / D, where
  // s^2 is the area of the surface for each surface point and D the diagonal: points with a spacing of s cannot show
  // finer detail, because the depth of an arc grows with the square of its chord. 0 sets no such limit. With 5,000
  // points and the default, the limit is about border_loss.
  double reach_detail = 7;
};

// Counts of what refine_axis() did.
struct RefineReport {
  Index vertices_before = 0, vertices = 0;
  Index inexact = 0;  // Vertices that stay in place because no ball with two contacts was found near them.
  Index single_contact_triangles = 0;  // Triangles removed because their two points have the same contact.
  Index border_cuts = 0;               // Edges cut where the loss passes border_loss.
  Index small_pieces = 0;              // Edges and triangles of spikes and flakes that were removed.
  Index vertices_moved = 0;            // Moves of vertices by smoothing; a vertex counts each time it is moved.
  Index filling_triangles = 0;         // Triangles added to fill notches of borders and openings along sharp edges.
  Index edge_vertices = 0;             // Vertices of radius 0 on sharp edges.
  Index reached_places = 0;            // Places of the surface for which step 4 added triangles.
  Index divided = 0;                   // Edges that were divided.
  Index undivided = 0;   // Edges beyond the tolerance that remain because they are too short or max_rounds is used up.
  Index degenerate = 0;  // Vertices merged with others at the same place, and flat triangles removed.
  double border_length = 0;  // The length of the borders of the result, over the diagonal.
};

// The result of refine_axis().
struct RefinedAxis {
  // The refined axis. Its faces are triangles, and it has no topology faces. Its points are the contacts of its
  // vertices, one to four for each vertex. The two points of a face are the two contacts of its corners that are seen
  // farthest apart. Vertices of radius 0 lie on sharp edges, so validate(axis, surface) does not hold.
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
// 4. Where the surface is left open by more than 1.65 max(border_loss, tolerance) and more than the limit of
//    reach_detail, or where balls leave a dent that is a tenth deeper than that, triangles are added to the nearest
//    edges and remeshed.
// 5. Cells whose interpolated balls are off by more than the tolerance are divided.
// The topology is that of `axis`, because each step preserves it: cells are divided, flipped, contracted under the link
// condition, collapsed from a free side, or added such that they could be collapsed again.
//
// `sampling` holds the points of `axis`. In the result, the radius of a vertex is the distance from its centre to the
// surface, up to rounding. Throws InputError unless surface.solid(), or if an option is out of range. Takes O(n log n)
// for n vertices, and several nearest-point queries for each vertex. The result is deterministic; the work is parallel.
RefinedAxis refine_axis(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis,
                        const RefineOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
