#pragma once
#include <filesystem>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/segments.h"
#include "orchard/viz/vtk_writer.h"

// A medial axis and what is known about it as ParaView opens it. The rules of vtk_writer.h hold.
namespace orchard {

// One unstructured grid (.vtu): a polygon for each face and wall, a line for each edge that no face has.
// Point arrays: radius; contact_angle (the widest at which two forming points are seen, radians); component; segment;
// added (1 if gap repair added a forming point); forming_points (four of them, -1 for none); forming_count. Cell
// arrays: segment; sheet (1, else a curve) and trunk (1, else a branch) of the segment; wall (1 for walls);
// contact_angle (at which the two points are seen, NaN for lines); point_a, point_b (-1 for lines); added; component.
// Of points and cells: structure (the number of its part in medial_structure()) and structure_kind (0 sheet, 1 seam, 2
// border, 3 junction, 4 curve).
// Also what `of_vertices` has, and `of_faces`: one value for each face, then for each wall; lines get NaN. Points are
// numbered as in the contacts of write_medial_axis().
void write_medial_grid(const std::filesystem::path& vtu, const MedialAxis& axis, const MedialSegments& segments,
                       const ViewArrays& of_vertices = {}, const ViewArrays& of_faces = {});

// The mesh with a point array `medial_radius`, and `thickness`, twice that; radii: of each vertex of the mesh. And what
// `more` has of each vertex.
void write_thickness(const std::filesystem::path& vtp, const Surface& surface, const std::vector<double>& radii,
                     const ViewArrays& more = {});

// A complete medial mesh of any system: triangles, and lines for the other edges. Point arrays: radius, structure and
// structure_kind, as above, and what `of_vertices` has. Cell arrays: structure, structure_kind.
void write_medial_mesh(const std::filesystem::path& vtp, const MedialMesh& mesh, const ViewArrays& of_vertices = {});

// One vertex per place, in order. Point arrays: number (from 1 on, as reports have it), measure (0 protrusion, 1
// coverage, 2 dent), value (in % of the diagonal), outward (the surface's normal there).
void write_worst_places(const std::filesystem::path& vtp, const std::vector<WorstPlace>& places);

// A polyline for each arc. Point arrays: radius; vertex (of the axis). Cell arrays: kind (0 curve, 1 border, 2
// junction), length, mean_radius, from, to (nodes, as in the GraphML).
void write_skeleton(const std::filesystem::path& vtp, const MedialAxis& axis, const SkeletonGraph& graph);

}  // namespace orchard
