#pragma once
#include <filesystem>
#include <span>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

// Writes small files that stand for large ones in ParaView. The rules of vtk_writer.h hold.
namespace orchard {

// Writes lines through which one sees what is inside a solid: its sharp edges (bent by more than 40 degrees), its open
// edges, and `sections` plane sections across each coordinate axis, evenly spaced. Cell array: kind (0 sharp or open
// edge, 1 section). Time: O(n log n) for n triangles.
void write_outline(const std::filesystem::path& vtp, const Surface& surface, int sections = 5);

// Writes one vertex for each ball. Point arrays: radius; vertex (of the axis, from `vertices`, which has a number for
// each ball).
void write_balls(const std::filesystem::path& vtp, std::span<const Sphere> balls, std::span<const Index> vertices);

}  // namespace orchard
