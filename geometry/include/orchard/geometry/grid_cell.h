#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "orchard/geometry/mesh.h"

namespace orchard {

// A cube of a grid, by its number along each axis.
using GridCell = std::array<std::int64_t, 3>;

// The cube that holds a place, given from the grid's origin, for cubes of this size (> 0, so that the numbers fit).
inline GridCell grid_cell(const Vector& from_origin, double size) {
  GridCell cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(from_origin[axis] / size));
  return cell;
}

// Cells that are near each other have hashes that are not.
inline std::uint64_t hash_of(const GridCell& cell) {
  std::uint64_t hash = 0;
  for (const std::int64_t coordinate : cell) {
    hash = (hash ^ static_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace orchard
