#pragma once
#include <array>

#include "predicates/predicates.h"

// The predicates of predicates.h for four tetrahedra at once, with the same bits.
namespace orchard::detail {

// The corners of each: by corner, then by tetrahedron.
using FourTetrahedra = std::array<std::array<const Point*, 4>, 4>;

bool can_take_four();  // whether the machine has vectors of four doubles and the fused operation (AVX2 and FMA),
                       // without which the rest does nothing

// volume() of the vectors from 3 to 0, 1 and 2.
struct FourVolumes {
  std::array<double, 4> value, bound;
};
FourVolumes four_volumes(const FourTetrahedra& tetrahedra);

// Returns inside_sphere() of one point. It is also uncertain where some 104 bits do not decide.
std::array<Sign, 4> four_inside_spheres(const Point& q, const FourTetrahedra& tetrahedra);

// The results of off_circumcenter() from point 3, of points 0, 1 and 2, and of sharply_off_circumcenter().
struct FourOffCenters {
  std::array<double, 4> off, rest, x, y, z;  // the coordinates of the step are x, y and z
};
FourOffCenters off_four_circumcenters(const std::array<const Point*, 4>& centers, const FourTetrahedra& tetrahedra);
FourOffCenters sharply_off_four_circumcenters(const std::array<const Point*, 4>& centers,
                                              const FourTetrahedra& tetrahedra);

// Computes sharp_circumcenter() from point 0, of points 1, 2 and 3. Returns a bit for each center that it found; the
// others have to be computed by sharp_circumcenter().
unsigned four_sharp_circumcenters(const FourTetrahedra& tetrahedra, std::array<Vector, 4>& centers);

}  // namespace orchard::detail
