#pragma once
#include <filesystem>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/segments.h"

// A medial axis and what is known about it as ParaView opens it. The rules of vtk_writer.h hold.
namespace orchard {

// One unstructured grid (.vtu): a polygon for each face and wall, a line for each edge that no face has.
// Point arrays: radius; angle (the widest at which two forming points are seen, radians); component; segment; added (1
// if gap repair added a forming point); forming_points (four of them, -1 for none); forming_count.
// Cell arrays: segment; sheet (1, else a curve) and trunk (1, else a branch) of the segment; wall (1 for walls); angle
// (at which the two points are seen, -1 for lines); point_a, point_b (-1 for lines); added; component.
void write_medial_grid(const std::filesystem::path& vtu, const MedialAxis& axis, const MedialSegments& segments);

// The mesh with a point array `medial_radius`, and `thickness`, twice that. radii: of each vertex of the mesh.
void write_thickness(const std::filesystem::path& vtp, const Surface& surface, const std::vector<double>& radii);

// A polyline for each arc. Point arrays: radius; vertex (of the axis). Cell arrays: kind (0 curve, 1 border, 2
// junction), length, mean_radius, from, to (nodes, as in the GraphML).
void write_skeleton(const std::filesystem::path& vtp, const MedialAxis& axis, const SkeletonGraph& graph);

}  // namespace orchard
