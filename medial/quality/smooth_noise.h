#pragma once
#include <array>
#include <cstdint>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A random field of displacements of length one at most: independent unit vectors at the corners of a lattice of cubes,
// interpolated with weights that rise smoothly from corner to corner ("value noise", Perlin 1985). Places farther apart
// than two diagonals of a cube move independently. The field depends on the place in space only, not on the mesh.
// Deterministic for a seed.
class SmoothNoise {
 public:
  // `spacing` is that of the lattice, which has a corner at the lower corner of the box. Precondition: it is above 0.
  SmoothNoise(const Box& box, double spacing, std::uint64_t seed);
  // Precondition: the place is in the box, up to rounding.
  Vector operator()(const Point& place) const;

 private:
  Vector direction(std::uint64_t corner) const;

  Point origin_;
  double spacing_;
  std::uint64_t seed_;
  std::array<std::uint64_t, 3> corners_{};  // of the lattice, along each axis
};

// Returns the same surface in triangles whose edges are no longer than `max`. Longer edges are halved repeatedly.
// Precondition: max is above 0.
TriangleMesh with_short_edges(TriangleMesh mesh, double max);

}  // namespace orchard::detail
