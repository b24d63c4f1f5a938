#pragma once
#include <cstdint>

#include "orchard/geometry/mesh.h"

// Meshes for tests and benchmarks: closed, manifold, oriented outward unless the name says otherwise.
namespace orchard::test {

TriangleMesh box(const Point& lower, const Point& upper);     // 12 triangles, 6 clusters
TriangleMesh icosphere(int subdivisions, double radius = 1);  // 20 * 4^n triangles on the sphere around the origin
TriangleMesh torus(int around, int across, double major_radius = 1, double minor_radius = 0.35);
TriangleMesh l_shape();              // extruded L: nonconvex, coplanar clusters
TriangleMesh u_shape(double gap);    // extruded U whose arms are `gap` apart, in [0, 3] x [0, 2] x [0, 1]
TriangleMesh two_boxes(double gap);  // two components side by side along x
TriangleMesh open_box();             // a box without its top: not closed
TriangleMesh transformed(TriangleMesh mesh, double scale, const Vector& offset);
TriangleMesh mirrored(TriangleMesh mesh);  // inside out

}  // namespace orchard::test
