#pragma once
#include <array>
#include <vector>

#include "orchard/medial/medial_mesh.h"

// Solids whose medial axis is known in closed form, with that axis.
namespace orchard::test {

struct KnownAxis {
  TriangleMesh solid;
  MedialMesh axis;
};

// The box from the origin to `sizes`, which must ascend: a rectangle in the middle and twelve sheets to the edges.
KnownAxis known_box(const std::array<double, 3>& sizes);
// One ball; the mesh is inscribed, with 20 * 4^n triangles.
KnownAxis known_sphere(int subdivisions);
// A prism around z with `sides` sides, circumscribed about radius 1, and `height` > 2: a segment, and two cones of
// sheets to the rims; exact but for the sheets into the edges along z, which have next to no radius difference.
KnownAxis known_cylinder(Index sides, double height);
// A circle of `around` points.
KnownAxis known_torus(Index around, Index across);

// A prism of height 2 over the outline (0,0) (2,0) (2,1) (1,1) (1,2) (0,2): the outline's planar axis (centre lines of
// the arms, diagonals into the convex corners, and two parabolas between the reentrant corner and the outer sides)
// swept along z, between two roofs over the outline that rise with the distance to it. Exact but for the cone of the
// roofs around the reentrant corner and for the parabolas, which are cut into `pieces` chords each.
KnownAxis known_l_shape(Index pieces);

// Triangles that hold all of an axis: its own, and flat ones for its edges and vertices. For distances to it.
TriangleMesh as_triangles(const MedialMesh& axis);
// Points on all of an axis: its vertices, and evenly spaced ones on edges and triangles, about `step` apart.
std::vector<Point> points_on(const MedialMesh& axis, double step);

}  // namespace orchard::test
