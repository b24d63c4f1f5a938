#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// Returns which vertices of the diagram lie inside the surface (dissertation 6.2.1). Vertices at infinity and those
// without a finite centre do not. Every eighth vertex is tested by a query of the signed distance. A vertex that is
// nearer to a decided one than the surface is lies on the same side, which decides most others along the Voronoi edges;
// the rest is tested by queries, too. Throws InputError unless surface.solid(). The result is deterministic; the work
// is parallel.
std::vector<std::uint8_t> interior_vertices(const Surface& surface, const VoronoiDiagram& diagram,
                                            const Progress& progress = {});

}  // namespace orchard::detail
