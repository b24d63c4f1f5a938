#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/tree.h"

// The values of the pipeline as ParaView opens them: XML PolyData (.vtp), zlib-compressed, coordinates and lengths as
// doubles in mesh units, with NaN where there is no value, indices as 32-bit integers with -1 for kNone. The same bytes
// for the same value. Files appear as a whole or not at all; every function throws Error if its file cannot be written,
// and the file's folder must exist.
namespace orchard {

// Values of one's own beside the arrays that a file has anyhow: one for each point, vertex or face.
struct ViewArray {
  std::string name;
  std::vector<double> values;
};
using ViewArrays = std::vector<ViewArray>;

// Triangles; cell array `cluster`. Field data `bounding_radius`: what tolerances and figures are fractions of.
void write_mesh(const std::filesystem::path& vtp, const Surface& surface);

// One vertex per surface point; point arrays `origin` (0 face, 1 edge, 2 repair) and `triangle`, and `more` of each.
void write_points(const std::filesystem::path& vtp, const SurfaceSampling& sampling, const ViewArrays& more = {});

// A name that several files begin with: "out/lamp-build" and "-mesh.vtp" make "out/lamp-build-mesh.vtp".
std::filesystem::path with_ending(const std::filesystem::path& prefix, const std::string& ending);

// Four files. The first three can each be shown alone; vertices are numbered alike in them and carry the point arrays
// `radius`, `contact_angle` (contact_angles(), radians), `component` and `valence` (number of neighbours), and what
// `of_vertices` has.
//   PREFIX-vertices.vtp  the medial vertices
//   PREFIX-edges.vtp     a line per pair of neighbours
//   PREFIX-faces.vtp     the faces; cell arrays `point_a`, `point_b`: the two contacts that a face separates, and
//                        `contact_angle`: separation_angle(), in radians, as in write_medial_grid(). Small angles
//                        belong to sheets that run into shallow edges and noise: a threshold clears the view. And what
//                        `of_faces` has, one value for each face and then for each wall, which is not drawn.
//   PREFIX-contacts.vtp  MedialAxis::points, one vertex each: what `point_a`, `point_b` and the `forming_points` of
//                        write_medial_grid() count; point array `origin` as in write_points(). Those of a raw axis are
//                        its surface points, those of a refined one where its balls touch the surface.
void write_medial_axis(const std::filesystem::path& prefix, const MedialAxis& axis, const ViewArrays& of_vertices = {},
                       const ViewArrays& of_faces = {});

// The spheres of one level as points, for glyphs scaled by `radius`: the nodes of that level and, flagged `carried`,
// the leaves above it, which stand in for the children they do not have. Point arrays:
//   radius, error (distance_bound), inaccuracy   lengths, as measure() left them; NaN if infinite, which is unknown
//   level, node, parent                          of the node; indices into SphereTree::nodes
//   branch                                       the child of the root that the node descends from, counted from 0; -1
//                                                for the root itself
//   carried                                      1 if the node is a leaf of a level above, else 0
// A level below the deepest gives all leaves.
void write_tree_level(const std::filesystem::path& vtp, const SphereTree& tree, Index level);

struct NamedFile {
  std::string name;            // shown by ParaView
  std::filesystem::path file;  // relative to the .vtm
};

// A .vtm that opens several files at once. The files need not exist yet.
void write_multiblock(const std::filesystem::path& vtm, std::span<const NamedFile> files);

enum class UpAxis { x, y, z };

// What a run of the pipeline made; null: it did not make that.
struct PipelineValues {
  const Surface* surface = nullptr;
  const SurfaceSampling* sampling = nullptr;
  const MedialAxis* axis = nullptr;
  const SphereTree* tree = nullptr;
  UpAxis up = UpAxis::y;  // the mesh's axis that points up in ParaView
};

// Writes all of it: PREFIX-mesh.vtp, PREFIX-points.vtp, PREFIX-medial-{vertices,edges,faces}.vtp, PREFIX-level-N.vtp
// for every level, and PREFIX.vtm, which opens them; PREFIX.pvd with the levels as steps of time; and PREFIX-view.py,
// which shows the spheres around the mesh (paraview --script, pvbatch). Returns the files in the order of the .vtm,
// which names them "mesh", "surface points", "medial vertices", "medial edges", "medial faces", "tree level N".
std::vector<NamedFile> write_pipeline(const std::filesystem::path& prefix, const PipelineValues& values);

// PREFIX.pvsm: a state of ParaView (5.11 or later), which opens by a double click: the last level's spheres around the
// mesh, as PREFIX-view.py shows them. States name their files absolutely: `folder` is where those of write_pipeline()
// will be. Precondition: a surface, and a tree with nodes.
void write_paraview_state(const std::filesystem::path& prefix, const PipelineValues& values,
                          const std::filesystem::path& folder);

}  // namespace orchard
