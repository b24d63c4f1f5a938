#pragma once
#include <filesystem>

#include "orchard/medial/curve_skeleton.h"

// Writes curve skeletons for ParaView. The rules of vtk_writer.h hold.
namespace orchard {

// Writes a polyline for each curve, a vertex for each single point, and the triangles of closed sheets.
// Point arrays: radius, burn_time and erosion_thickness (mesh units, NaN on closed sheets), node (1 at ends and
// branchings).
// Cell arrays: curve (its number, -1 for points and triangles), length, min_radius, mean_radius, significance (NaN for
// loops, and all four for points and triangles), curve_of_axis (1 if the axis has no sheets there).
void write_curve_skeleton(const std::filesystem::path& vtp, const CurveSkeleton& skeleton);

}  // namespace orchard
