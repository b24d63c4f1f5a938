#pragma once
#include "voronoi/point_sets.h"

// Sets of points on which one algorithm or the other is slow: of very different densities, regular up to rounding, or
// with many more Voronoi vertices than points. Deterministic; about n points.
namespace orchard::bench {

test::Points cluster_points(std::size_t n, std::uint64_t seed);     // five Gaussian clusters, sigma 1 to 1e-4
test::Points cylinder_ring_points(int rings, int around);           // evenly spaced rings, length 10 and radius 2
test::Points torus_lattice_points(int around, int across);          // a regular lattice of the torus's angles
test::Points integer_grid_points(int k);                            // k^3: every difference is exact
test::Points noisy_line_points(std::size_t n, std::uint64_t seed);  // ten random lines, off by some 1e-5
test::Points moment_curve_points(std::size_t n);                    // (t, t^2, t^3): n^2 / 2 vertices
test::Points skew_line_points(std::size_t n, std::uint64_t seed);   // random on two lines: n^2 / 4 vertices

}  // namespace orchard::bench
