#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// Where a surface cuts itself, a sheet may stick out of the solid inside out; next to it the nearest feature calls
// places inside that are not. There the forming points are asked, too: a vertex is outside if the surface faces it at
// three of them at least. inside: of each vertex, those outvoted become 0. `normals`: of the surface at each point.
// Surfaces that do not cut themselves are left alone: their nearest features are right.
void drop_outvoted(const Surface& surface, std::span<const Vector> normals, const VoronoiDiagram& diagram,
                   std::vector<std::uint8_t>& inside);

}  // namespace orchard::detail
