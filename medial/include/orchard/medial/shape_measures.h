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
  // The length of the edges with at least three triangles, and of those with none.
  double seam_length = 0, wire_length = 0;
  // The quality of a triangle is Q = 6 / sqrt(3) * area / (half the perimeter * longest edge), which is 1 if it is
  // equilateral: the mean, the 5th percentile, and the share of triangles with Q below 0.1.
  double quality_mean = 0, quality_5 = 0, quality_below = 0;
  // The 90th over the 10th percentile of the lengths of the edges of triangles.
  double edge_spread = 0;
  Index border_vertices = 0;  // Vertices with exactly two border edges.
  // The share of these vertices at which the border turns by more than 60 degrees.
  double border_turns = 0;
  // The length of the border through these vertices over the length of the lines between their two neighbours.
  double border_roughness = 0;
  // The number of these vertices that are farther from the line through their neighbours than half the distance between
  // the neighbours.
  Index flaps = 0;
  Index forked_borders = 0;  // Vertices with more than two border edges.
};
// Measures a medial mesh. Precondition: the mesh is complete as validate() requires, and diagonal > 0 (mesh units). O(n
// log n).
ShapeMeasures shape_measures(const MedialMesh& mesh, double diagonal);

}  // namespace orchard
