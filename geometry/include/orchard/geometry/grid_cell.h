#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "orchard/geometry/mesh.h"

// Cells of a regular grid, and their hash values.
namespace orchard {

// A cube of a grid, by its number along each axis.
using GridCell = std::array<std::int64_t, 3>;

// Returns the cube that contains a point. `from_origin` is the point relative to the origin of the grid. `size` is the
// edge length of the cubes; it must be above 0 and so large that the numbers of the cubes fit into 64 bits.
inline GridCell grid_cell(const Vector& from_origin, double size) {
  GridCell cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(from_origin[axis] / size));
  return cell;
}

// Returns a hash value of a cube. The values of neighbouring cubes differ in many bits.
inline std::uint64_t hash_of(const GridCell& cell) {
  std::uint64_t hash = 0;
  for (const std::int64_t coordinate : cell) {
    hash = (hash ^ static_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace orchard
