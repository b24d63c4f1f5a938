#pragma once
#include "orchard/medial/medial_mesh.h"

// Measures the mesh quality of a medial mesh, independently of the solid.
namespace orchard {

// Measures of the sheets, borders and triangles of a medial mesh. docs/reference/medial-measures.md defines each
// measure. Lengths are over the given diagonal. A value is NaN if there is nothing to measure.
struct ShapeMeasures {
  Index sheets = 0;        // Sets of triangles that are joined across edges with exactly two triangles.
  Index small_sheets = 0;  // Sheets with a bounding box whose diagonal is below their largest radius.
  Index tiny_sheets = 0;   // Sheets of at most three triangles.
  // The total length of the edges with at least three triangles, and of the edges without triangles.
  double seam_length = 0, curve_length = 0;
  // The quality of triangles: the mean, the 5th percentile, and the share of triangles with a quality below 0.1. The
  // quality is 6 / sqrt(3) * area / (half the perimeter * longest edge), which is 1 for an equilateral triangle.
  double quality_mean = 0, quality_5 = 0, quality_below = 0;
  // The 90th percentile of the lengths of the edges of triangles, divided by the 10th.
  double edge_spread = 0;
  Index border_vertices = 0;  // Vertices with exactly two border edges.
  // The share of these vertices at which the border turns by more than 60 degrees.
  double border_turns = 0;
  // The total length of the two border edges at each of these vertices, divided by the total distance between its two
  // neighbours. It is 1 if the borders are straight.
  double border_roughness = 0;
  // The number of these vertices at which the border makes a sharp tooth: the distance of the vertex from the line
  // through its two neighbours is more than half the distance between the neighbours.
  Index flaps = 0;
  Index forked_borders = 0;  // Vertices with more than two border edges.
};
// Measures a medial mesh. Precondition: the mesh is complete as validate() requires, and diagonal > 0 (mesh units). O(n
// log n).
ShapeMeasures shape_measures(const MedialMesh& mesh, double diagonal);

}  // namespace orchard
