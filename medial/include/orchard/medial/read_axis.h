#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

// Reads medial axes from the files of many systems, and places them on a solid.
namespace orchard {

// A medial axis as a file of some system contains it; docs/reference/formats.md lists the formats.
struct ForeignAxis {
  MedialMesh mesh;  // Complete and valid. Radii are 0 if has_radii is false.
  // Whether the file contains radii. If it does not, place_axis() computes them.
  bool has_radii = true;
  std::vector<StructurePart> structure = {};      // By the cells of `mesh`; empty if the file has none.
  std::vector<std::filesystem::path> files = {};  // The files that were read, the requested one first.
  std::vector<std::string> notes = {};            // A sentence for each decision and for each omission.
};

// Reads a medial axis. The extension of the file, in upper or lower case, determines the format:
// - .ma, .ma_dup, .ma_struct: Q-MAT, MATFP, MATTopo and MATStruct;
// - .obj: vertices, lines and faces; a fourth number of every vertex is its radius, unless all of them are 1;
// - .ply: VMAS, CGAL and others, ASCII or binary; the vertex property radius or r, if any, and edges and faces;
// - .off: the faces, or the points alone; with Point2Skeleton's names (.._center.off, .._skel_face.obj,
//   .._skel_edge.obj, .._sphere.obj), or an .obj of the same name, all of these files make one axis;
// - .sph: the balls of MATFP and MATTopo ("4 n", then lines "x y z r");
// - .swc, .cg, .cgal: skeleton graphs, which have edges alone;
// - .txt, .xyz, .xyzr, .balls: balls or centres, one on each line, with or without a "v" in front.
// Text that an axis does not need is skipped. Throws InputError, which names the file, the line or byte, and the fault.
// Takes O(n log n) time and O(n) memory in the size of the files.
ForeignAxis read_axis(const std::filesystem::path& file);
// Returns the extensions that read_axis() knows, in lower case and with their dots.
std::span<const char* const> axis_extensions();

// The options of place_axis().
struct PlaceOptions {
  // Whether balls without edges are connected by connect_balls().
  bool connect = false;
};

// The axis of a file, checked against a solid.
struct PlacedAxis {
  MedialMesh mesh;
  // The structure in the file; empty if place_axis() connected the balls.
  std::vector<StructurePart> structure = {};
  std::vector<std::string> notes = {};  // The notes of the file, and those of place_axis().
  // Whether the file has no radii, so that they were computed as distances to the surface.
  bool radii_found = false;
  // Whether the file has no cells, so that connect_balls() computed them.
  bool connected = false;
};

// Checks an axis against a solid. Computes the radii if the file has none, and the cells if it has none and `options`
// ask for them. Throws InputError
// - if the balls do not lie near the surface (tolerance::kFrameError); the message names the scale and translation that
//   would fit, if one of the frames that programs commonly use does;
// - if the cells are the surface itself, as in files that a program wrote as a start;
// - unless surface.solid().
// Takes O(n log m): one distance query for each ball.
PlacedAxis place_axis(const Surface& surface, ForeignAxis axis, const PlaceOptions& options = {});

// The axis that connect_balls() builds from balls.
struct ConnectedBalls {
  MedialMesh mesh;
  Index left_out = 0;    // Balls whose cell contains no part of the solid.
  Index tetrahedra = 0;  // Tetrahedra that no collapse removes.
};
// Connects balls by their power diagram within the solid: each facet of the diagram that meets the solid gives an edge,
// and each edge of the diagram a triangle (the nerve, as in MATTopo, Wang et al. 2024). Balls without a part of the
// solid are left out. Where four balls meet inside the solid, there is a tetrahedron, which is collapsed from a free
// side; tetrahedra without a free side keep their four triangles.
// The result has the topology of the solid if no tetrahedra are left and if each part of the solid that belongs to one
// ball, two or three is in one piece without holes. With few balls this is often false: a ball that is the nearest one
// to two legs joins them and adds a loop.
// Throws InputError unless surface.solid() and validate(balls) passes. Takes O(n log n) for n balls in general
// position, and tests of the surface at each cell.
ConnectedBalls connect_balls(const Surface& surface, const MedialMesh& balls);

}  // namespace orchard
