#pragma once
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "orchard/geometry/mesh.h"

// Point sets for the tests and the benchmark of voronoi/. Deterministic; about n points unless said otherwise.
namespace orchard::test {

using Points = std::vector<Point>;

inline constexpr double kTurn = 2 * std::numbers::pi;  // radians

Points uniform_points(std::size_t n, std::uint64_t seed);       // in the unit cube
Points box_face_points(std::size_t n, std::uint64_t seed);      // random, exactly on the faces of a unit cube
Points bumpy_sphere_points(std::size_t n, std::uint64_t seed);  // random, on a sphere with smooth bumps
Points torus_points(std::size_t n, std::uint64_t seed);         // random, on a torus
Points sphere_points(std::size_t n, std::uint64_t seed);        // random, on the unit sphere up to rounding
Points relaxed_box_points(std::size_t n, std::uint64_t seed);   // near a jittered lattice, exactly on a cube's faces
Points relaxed_polyhedron_points(std::size_t n, std::uint64_t seed);  // the same, turned: on the faces up to rounding
Points box_lattice_points(int k);                                     // lattice on the faces of a cube: 6 k^2 + 2
Points grid_points(int k);                                            // k^3 lattice
Points body_centered_points(int k);                                   // 2 k^3: every cell has a 24-fold symmetry
Points cone_ring_points(int rings, int around);                       // evenly spaced rings of a cone and its tip

Points turned(const Points& points, std::uint64_t seed);  // by a random rotation: loses exact coincidences to rounding
Points moved(Points points, double scale, const Vector& offset);

// Sets on which exact arithmetic would see ties: the names say which.
std::vector<std::pair<std::string, Points>> degenerate_point_sets();

}  // namespace orchard::test
