#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/tree.h"

// Writes the values of the pipeline as XML PolyData (.vtp) for ParaView. Files are zlib-compressed. Coordinates and
// lengths are doubles in mesh units, with NaN where there is no value; indices are 32-bit integers with -1 for kNone.
// The same value gives the same bytes. Files are written completely or not at all. Every function throws Error if its
// file cannot be written; the folder of the file must exist.
namespace orchard {

// An array of the caller in addition to the arrays that a file always has: one value for each point, vertex or face.
struct ViewArray {
  std::string name;
  std::vector<double> values;
  bool counts = false;  // Whether the values are whole numbers, which the file has as 32-bit integers.
};
using ViewArrays = std::vector<ViewArray>;

// Writes triangles with a cell array `cluster`. The field data `bounding_radius` is the length R, of which tolerances
// and reported values are fractions.
void write_mesh(const std::filesystem::path& vtp, const Surface& surface);

// Writes one vertex for each surface point, with point arrays `origin` (0 face, 1 edge, 2 repair) and `triangle`, and
// the arrays `more`.
void write_points(const std::filesystem::path& vtp, const SurfaceSampling& sampling, const ViewArrays& more = {});

// Appends an ending to a common prefix of file names: "out/lamp-build" and "-mesh.vtp" give "out/lamp-build-mesh.vtp".
std::filesystem::path with_ending(const std::filesystem::path& prefix, const std::string& ending);

// Writes a medial axis to four files. The first three number the vertices alike and can each be shown alone. They have
// the point arrays `radius`, `contact_angle` (contact_angles(), in degrees), `component` and `valence` (number of
// neighbours), and the arrays `of_vertices`.
//   PREFIX-vertices.vtp  the medial vertices
//   PREFIX-edges.vtp     a line for each pair of neighbours
//   PREFIX-faces.vtp     the faces, with cell arrays `point_a` and `point_b`, the two contacts that a face separates,
//                        and `contact_angle`, which is separation_angle() in degrees, as in write_medial_grid(). Small
//                        angles belong to sheets that run into shallow edges and noise; a threshold hides them. The
//                        arrays `of_faces` have one value for each face and then for each topology face, which are not
//                        drawn.
//   PREFIX-contacts.vtp  MedialAxis::points, one vertex each, to which `point_a`, `point_b` and the `forming_points` of
//                        write_medial_grid() refer; point array `origin` as in write_points(). The contacts of a raw
//                        axis are its surface points, and those of a refined axis the places where its balls touch the
//                        surface.
void write_medial_axis(const std::filesystem::path& prefix, const MedialAxis& axis, const ViewArrays& of_vertices = {},
                       const ViewArrays& of_faces = {});

// Writes the spheres of one level as points, for glyphs scaled by `radius`: the nodes of that level and the leaves
// above it, which replace the children that they do not have. A level below the deepest one gives all leaves. Point
// arrays:
//   radius, error (distance_bound), inaccuracy   lengths as measure() computed them; NaN if unknown (infinite)
//   level, node, parent                          of the node; indices into SphereTree::nodes
//   branch                                       the child of the root that the node descends from, counted from 0; -1
//                                                for the root itself
//   carried                                      1 if the node is a leaf of a level above, otherwise 0
void write_tree_level(const std::filesystem::path& vtp, const SphereTree& tree, Index level);

// A file of a .vtm.
struct NamedFile {
  std::string name;            // The name that ParaView shows.
  std::filesystem::path file;  // Relative to the .vtm.
};

// Writes a .vtm, which opens several files at once. The files need not exist yet.
void write_multiblock(const std::filesystem::path& vtm, std::span<const NamedFile> files);

// The axis of a mesh that points up.
enum class UpAxis { x, y, z };

// The values of a run of the pipeline. A null pointer stands for a value that the run did not compute.
struct PipelineValues {
  const Surface* surface = nullptr;
  const SurfaceSampling* sampling = nullptr;
  const MedialAxis* axis = nullptr;
  const SphereTree* tree = nullptr;
  // A sphere set, as the first level of a tree: see ball_tree().
  const SphereTree* spheres = nullptr;
  // The axis of the mesh that points up in ParaView.
  UpAxis up = UpAxis::y;
};

// Writes all values: PREFIX-mesh.vtp, PREFIX-points.vtp, PREFIX-medial-{vertices,edges,faces}.vtp, PREFIX-level-N.vtp
// for every level, PREFIX-spheres.vtp, and PREFIX.vtm, which opens them; PREFIX.pvd with the levels as steps of time;
// and PREFIX-view.py, which shows the spheres around the mesh (paraview --script, pvbatch). Returns the files in the
// order of the .vtm, which names them "mesh", "surface points", "medial vertices", "medial edges", "medial faces",
// "tree level N", "spheres".
std::vector<NamedFile> write_pipeline(const std::filesystem::path& prefix, const PipelineValues& values);

// Writes PREFIX.pvsm, a state of ParaView (5.11 or later) that opens by a double click. It shows the spheres of the
// last level around the mesh, as PREFIX-view.py does. `folder` is the absolute folder where the files of
// write_pipeline() will be, because states contain absolute file names. Precondition: there are a surface and a tree
// with nodes.
void write_paraview_state(const std::filesystem::path& prefix, const PipelineValues& values,
                          const std::filesystem::path& folder);

}  // namespace orchard
