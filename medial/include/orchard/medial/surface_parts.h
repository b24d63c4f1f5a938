#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

// Divides the surface of a solid into parts by its medial axis. docs/guide/segments.md explains it with pictures.
namespace orchard {

// What the parts of a surface are.
enum class PartKind : std::uint8_t {
  // The places whose balls lie on one sheet or curve of the axis (medial_structure()).
  sheets,
  // The places whose balls lie on one side of all significant necks of the axis.
  necks,
  // Both: the sheets, cut at necks.
  both
};

// The options of surface_parts().
struct PartOptions {
  PartKind kind = PartKind::both;
  // The smallest significance of a neck, in [0, 1]. A neck is the widest passage between two places of the axis at
  // which the radius is largest; its significance is 1 - radius of the neck / radius of the smaller place. Less
  // significant necks do not cut. With 0 every dent of the radius cuts, and with 1 nothing does.
  double neck = 0.2;
  // The smallest area of a connected patch as a fraction of the area of the surface, at least 0. Smaller patches join
  // the neighbour with which they share the longest seam.
  double min_area = 0.002;
  // The approximate number of triangles after dividing edges, at least 1. Seams run along their edges. Larger meshes
  // are not coarsened.
  Index samples = 20'000;
  // The number of rounds, at least 0, in which seams are smoothed: a triangle joins the part with which it shares more
  // of its border than with its own.
  int smoothing = 5;
  // The longest edge of the divided axis on which necks are found, as a fraction of the diagonal, above 0.
  double edge_length = 0.0075;
};

// The parts of a surface.
struct SurfaceParts {
  // The mesh of the surface with its long edges divided. The vertices of the surface come first, in their order.
  TriangleMesh mesh;
  std::vector<Index> of_triangle;  // The triangle of the surface that each triangle is a piece of.
  std::vector<Index> parts_of;     // The part of each triangle: each triangle has exactly one.
  std::vector<double> radii;       // The radius of the ball that touches the middle of each triangle, in mesh units.

  struct Part {
    Index sheet = kNone;  // The sheet or curve of the axis, counted among those of medial_structure(); kNone for necks.
    Index region = kNone;   // The region of the axis between necks, as in Neck; kNone for sheets.
    Index triangles = 0;    // The number of its triangles.
    Index patches = 0;      // The number of connected patches; both sides of a plate are two of one part.
    double area = 0;        // In squared mesh units.
    double max_radius = 0;  // The largest of `radii`.
  };
  std::vector<Part> parts;  // The largest first.

  // A neck that cuts.
  struct Neck {
    Index a = 0, b = 0;  // The regions on its sides.
    Point place = Point::Zero();
    double radius = 0;        // Of the ball there, in mesh units.
    double significance = 0;  // As in PartOptions::neck.
  };
  Index regions = 0;        // The number of regions of the axis between necks.
  std::vector<Neck> necks;  // The most significant first.
};

// Divides the surface of a solid. `axis` is its medial axis, for example that of medial_mesh(). Every triangle of the
// divided mesh goes to the place of the axis that is nearest to the centre of the largest ball in the solid that
// touches its middle (thickness_at()). Regions are the basins of the radius function on the axis: they grow from the
// places of largest radius downward, and merge where they meet at an insignificant neck. Source: Chazal, Guibas, Oudot,
// Skraba: Persistence-based clustering in Riemannian manifolds, Journal of the ACM 60 (6), 2013, with relative
// persistence. Throws InputError unless surface.solid() and validate(axis) passes, and if an option is out of range.
// The result is the same on any number of threads. O(n log n).
SurfaceParts surface_parts(const Surface& surface, const MedialMesh& axis, const PartOptions& options = {},
                           const Progress& progress = {});

// Returns a part as a mesh of its own, open at its seams. Its vertices are those that it uses, in their order.
TriangleMesh part_mesh(const SurfaceParts& parts, Index part);

}  // namespace orchard
