#pragma once
#include <array>

#include "predicates/predicates.h"

// What predicates.h tells of a tetrahedron, bit for bit, for four tetrahedra at once.
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

// inside_sphere() of one point: uncertain also where some 104 bits do not tell.
std::array<Sign, 4> four_inside_spheres(const Point& q, const FourTetrahedra& tetrahedra);

// off_circumcenter() from 3, of 0, 1 and 2, and sharply_off_circumcenter().
struct FourOffCenters {
  std::array<double, 4> off, rest, x, y, z;  // and the step's coordinates
};
FourOffCenters off_four_circumcenters(const std::array<const Point*, 4>& centers, const FourTetrahedra& tetrahedra);
FourOffCenters sharply_off_four_circumcenters(const std::array<const Point*, 4>& centers,
                                              const FourTetrahedra& tetrahedra);

// sharp_circumcenter() from 0, of 1, 2 and 3. A bit for each center that it found, which leaves the rest to that.
unsigned four_sharp_circumcenters(const FourTetrahedra& tetrahedra, std::array<Vector, 4>& centers);

}  // namespace orchard::detail
