#pragma once
#include <span>
#include <string_view>

#include "insertion.h"
#include "orchard/geometry/progress.h"
#include "orchard/voronoi/diagram.h"
#include "orchard/voronoi/insertion_report.h"

namespace orchard::detail {

// What the incremental algorithms share: leaving out coincident points, ordering, the first four points, insertion, and
// turning the workspace into a diagram.
VoronoiDiagram build_voronoi(std::span<const Point> points, Search search, std::string_view stage,
                             const Progress& progress, InsertionReport* report);

// The box of the points; throws InputError, naming the point, for a coordinate that is not finite.
Box checked_box(std::span<const Point> points);

// Four points far apart: each the farthest from what those before it span.
std::array<Index, 4> spanning_points(std::span<const Point> points);

// Of what the points span, exactly: 3 if they are found not to lie in a plane.
int affine_dimension(std::span<const Point> points);

// Moves the vertices over the free ones and turns squared radii into radii. Forming points become original_of them,
// unless that is empty.
void finish(Workspace& workspace, std::span<const Index> original_of);

void add_counts(const InsertionCounts& counts, InsertionReport& report);

}  // namespace orchard::detail
