#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// Which vertices of the diagram lie inside the surface (dissertation 6.2.1); vertices at infinity and those without a
// finite centre never do. Every eighth vertex is asked of the surface; its distance then decides the neighbours that
// lie nearer to it than the surface does, and so on along the Voronoi edges; what stays open is asked as well. Throws
// InputError unless surface.solid(). Deterministic; parallel.
std::vector<std::uint8_t> interior_vertices(const Surface& surface, const VoronoiDiagram& diagram,
                                            const Progress& progress = {});

}  // namespace orchard::detail
