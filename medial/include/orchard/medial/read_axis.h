#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {

// A medial axis as the files of some system hold it (docs/reference/formats.md lists the kinds).
struct ForeignAxis {
  MedialMesh mesh;                                // complete and valid; radii are 0 where has_radii is false
  bool has_radii = true;                          // otherwise the file has none, and place_axis() finds them
  std::vector<StructurePart> structure = {};      // by the cells of `mesh`; empty where the file says nothing of it
  std::vector<std::filesystem::path> files = {};  // that were read; the one that was asked for comes first
  std::vector<std::string> notes = {};            // what was decided or left out, a sentence each
};

// Reads the axis of any system, by the extension of the file, whose case does not matter:
// - .ma, .ma_dup, .ma_struct: Q-MAT, MATFP, MATTopo and MATStruct;
// - .obj: vertices, lines and faces; a fourth number of every vertex is its radius, unless all of them are 1;
// - .ply: VMAS, CGAL and others, ASCII or binary; the vertex property radius or r, if any, and edges and faces;
// - .off: the faces, or the points alone; with Point2Skeleton's names (.._center.off, .._skel_face.obj,
//   .._skel_edge.obj, .._sphere.obj), or an .obj of the same name, all of them make one axis;
// - .sph: the balls of MATFP and MATTopo ("4 n", then lines "x y z r");
// - .swc, .cg, .cgal: skeleton graphs, which have edges alone;
// - .txt, .xyz, .xyzr, .balls: balls or centres, a line each, with or without a "v" in front.
// Text is read over where it is of no use for an axis. Throws InputError, which names the file, the line or byte, and
// what is wrong. Time grows with the size of the files (n log n), memory with it linearly.
ForeignAxis read_axis(const std::filesystem::path& file);
// These extensions, in lower case and with their dots.
std::span<const char* const> axis_extensions();

// What place_axis() is to do beside its checks.
struct PlaceOptions {
  bool connect = false;  // balls without edges by connect_balls()
};

// The axis of a file as that of one solid.
struct PlacedAxis {
  MedialMesh mesh;
  std::vector<StructurePart> structure = {};  // as the file has it; empty if it was connected here
  std::vector<std::string> notes = {};        // those of the file, and what was done here
  bool radii_found = false;                   // the file has none: they are distances to the surface
  bool connected = false;                     // the file has no cells: they are those of connect_balls()
};

// Finds the radii where the file has none, and the cells where it has none and `options` ask for them. Throws an
// InputError
// - if the balls do not lie near the surface (tolerance::kFrameError): it says which scale and move would fit, if one
//   of the frames that programs commonly use does;
// - if the cells are the surface itself, as in files that a program wrote as a start;
// - unless surface.solid().
// One distance for each ball: O(n log m).
PlacedAxis place_axis(const Surface& surface, ForeignAxis axis, const PlaceOptions& options = {});

// The axis that balls make by their power diagram within the solid: an edge or triangle for each facet or edge of the
// diagram that meets the solid (its nerve, as in MATTopo, Wang et al. 2024). Balls without a part of the solid are left
// out. Where four balls meet inside the solid there is a tetrahedron, which is collapsed from a free side; those that
// have none keep their four triangles. The topology is that of the solid if no tetrahedra are left and every part of
// the solid that belongs to one ball, two or three is in one piece without holes. With few balls it is often not: a
// ball that is the nearest to two legs joins them, and gives one loop too many.
struct ConnectedBalls {
  MedialMesh mesh;
  Index left_out = 0;    // balls without a part of the solid
  Index tetrahedra = 0;  // that no collapse removes
};
// O(n log n) for n balls in general position and tests of the surface at each cell. Throws InputError unless
// surface.solid() and validate(balls) passes.
ConnectedBalls connect_balls(const Surface& surface, const MedialMesh& balls);

}  // namespace orchard
