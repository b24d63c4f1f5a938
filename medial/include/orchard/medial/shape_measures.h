#pragma once
#include "orchard/medial/medial_mesh.h"

namespace orchard {

// How well a medial mesh is made: its sheets, borders and triangles, whatever solid it is of.
// docs/reference/medial-measures.md defines each measure. Lengths over the diagonal that is given. NaN where there is
// nothing to measure.
struct ShapeMeasures {
  Index sheets = 0;                         // of triangles that are joined across edges of exactly two
  Index small_sheets = 0;                   // whose bounding box has a diagonal below their largest radius
  Index tiny_sheets = 0;                    // of at most three triangles
  double seam_length = 0, wire_length = 0;  // of the edges of three triangles or more, and of none
  // Q = 6 / sqrt(3) * area / (half the perimeter * longest edge) of each triangle: 1 if it is equilateral.
  double quality_mean = 0, quality_5 = 0, quality_below = 0;  // 5th percentile; share below 0.1
  double edge_spread = 0;       // 90th over 10th percentile of the lengths of the edges of triangles
  Index border_vertices = 0;    // with exactly two border edges
  double border_turns = 0;      // share of them at which the border turns by more than 60 degrees
  double border_roughness = 0;  // length of the way over them, over that of the lines between their two neighbours
  Index flaps = 0;  // of them, those farther from the line through their neighbours than half the distance of these
  Index forked_borders = 0;  // vertices with more than two border edges
};
// O(n log n). Precondition: the mesh is complete, as validate() has it; diagonal > 0.
ShapeMeasures shape_measures(const MedialMesh& mesh, double diagonal);

}  // namespace orchard
