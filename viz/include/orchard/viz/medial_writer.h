#pragma once
#include <filesystem>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/contacts.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/segments.h"
#include "orchard/viz/vtk_writer.h"

// Writes medial axes and measures of them for ParaView. The rules of vtk_writer.h hold.
namespace orchard {

// Writes a medial axis as an unstructured grid (.vtu): a polygon for each face and topology face, and a line for each
// edge that belongs to no face. Point arrays: radius; contact_angle (the largest angle in degrees at which two forming
// points are seen); component; segment; added (1 if gap repair added a forming point); forming_points (four of them, -1
// for none); forming_count. Cell arrays: segment; has_faces (1 if the segment is a sheet, 0 if it is a curve); trunk (1
// if the segment is a trunk, 0 if it is a branch); topology_face (1 for these); contact_angle (the angle in degrees at
// which the two points are seen, NaN for lines); point_a, point_b (-1 for lines); added; component. Points and cells
// have structure (the number of the part in medial_structure()) and structure_kind (0 sheet, 1 seam, 2 border, 3
// junction, 4 curve). The file also contains the arrays `of_vertices`, and the arrays `of_faces`, which have one value
// for each face and then one for each topology face; lines get NaN. Surface points are numbered as in the contacts of
// write_medial_axis(). Field data: contact_ball, contact_sample, sample_ball and samples, as in write_medial_mesh().
void write_medial_grid(const std::filesystem::path& vtu, const MedialAxis& axis, const MedialSegments& segments,
                       const ViewArrays& of_vertices = {}, const ViewArrays& of_faces = {});

// Writes the mesh with two point arrays: `medial_radius`, which has the values `radii` of the vertices in mesh units,
// and `thickness`, which is twice that. The file also contains the arrays `more`, with a value for each vertex.
void write_thickness(const std::filesystem::path& vtp, const Surface& surface, const std::vector<double>& radii,
                     const ViewArrays& more = {});

// Writes a complete medial mesh of any system: its triangles, and lines for the other edges. Point arrays: radius,
// structure and structure_kind, as in write_medial_grid(), and the arrays `of_vertices`. Cell arrays: structure,
// structure_kind. With `contacts`, field data: contact_ball and contact_sample (for each contact), sample_ball (for
// each sample, -1 for none) and samples (their places).
void write_medial_mesh(const std::filesystem::path& vtp, const MedialMesh& mesh, const ViewArrays& of_vertices = {},
                       const AxisContacts* contacts = nullptr);

// Writes one vertex for each place, in order. Point arrays: number (from 1, as in reports), measure (0 protrusion, 1
// coverage, 2 dent), value (in % of the diagonal), outward (the surface's normal at the place).
void write_worst_places(const std::filesystem::path& vtp, const std::vector<WorstPlace>& places);

// Writes a polyline for each arc. Point arrays: radius; vertex (of the axis). Cell arrays: kind (0 curve, 1 border, 2
// seam), length, mean_radius, from, to (nodes, as in the GraphML).
void write_structure_graph(const std::filesystem::path& vtp, const MedialAxis& axis, const StructureGraph& graph);

}  // namespace orchard
