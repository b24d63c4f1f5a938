#pragma once
#include <array>

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

}  // namespace orchard::test
