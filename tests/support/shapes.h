#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

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
// Over a counter-clockwise polygon in the plane z = 0, whose caps are triangulated as given.
TriangleMesh prism(const std::vector<std::array<double, 2>>& polygon, const std::vector<std::array<Index, 3>>& caps,
                   double height = 1);
// Turned around z, `around` facets to a turn, from (radius, height) to (radius, height), upward; a first or last radius
// of 0 is an apex, any other one gets a flat end.
TriangleMesh turned(const std::vector<std::array<double, 2>>& profile, int around);
TriangleMesh joined(std::initializer_list<TriangleMesh> parts);  // one mesh of all, nothing welded
TriangleMesh soup(const TriangleMesh& mesh);                     // each triangle with vertices of its own: not closed
TriangleMesh transformed(TriangleMesh mesh, double scale, const Vector& offset);
TriangleMesh mirrored(TriangleMesh mesh);  // inside out

}  // namespace orchard::test
