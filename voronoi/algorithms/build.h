#pragma once
#include <span>
#include <string_view>

#include "insertion/insertion.h"
#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

namespace orchard::detail {

// What the incremental algorithms share: leaving out coincident points, ordering, the first four points, insertion, and
// turning the workspace into a diagram. With exact signs from the start if asked for.
VoronoiBuild build_voronoi(std::span<const Point> points, Search search, std::string_view stage,
                           const Progress& progress, bool exact = false);

// The box of the points; throws InputError, naming the point, for a coordinate that is not finite or beyond
// Frame::kMax, or if the points are not all one and yet nearer to each other than Frame::kMin.
Box checked_box(std::span<const Point> points);

// The lengths of a workspace whose points are those of the box, in the frame.
void set_scale(Workspace& workspace, const Frame& frame, const Box& box);

// Moves the vertices over the free ones, out of the frame, and turns squared radii into radii. Forming points become
// original_of them, unless that is empty.
void finish(Workspace& workspace, const Frame& frame, std::span<const Index> original_of);

void add_counts(const InsertionCounts& counts, InsertionReport& report);

}  // namespace orchard::detail
