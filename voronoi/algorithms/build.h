#pragma once
#include <span>
#include <string_view>

#include "insertion/insertion.h"
#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

namespace orchard::detail {

// The steps that the incremental algorithms share: coincident points are left out, the others are ordered, a diagram of
// four points is made, the rest are inserted, and the workspace becomes a diagram. `exact`: use exact signs from the
// start.
VoronoiBuild build_voronoi(std::span<const Point> points, Search search, std::string_view stage,
                           const Progress& progress, bool exact = false);

// The box of the points. Throws InputError, which names the point, if a coordinate is not finite or beyond Frame::kMax;
// also if the points are not all the same but the whole set is smaller than Frame::kMin.
Box checked_box(std::span<const Point> points);

// Sets the workspace's scale to that of the points in the box, in the coordinates of the frame.
void set_scale(Workspace& workspace, const Frame& frame, const Box& box);

// Turns the workspace's vertices into those of a diagram: closes the gaps that free vertices leave, brings the
// coordinates out of the frame, and replaces squared radii by radii. Unless `original_of` is empty, it gives the number
// that each forming point gets.
void finish(Workspace& workspace, const Frame& frame, std::span<const Index> original_of);

void add_counts(const InsertionCounts& counts, InsertionReport& report);

}  // namespace orchard::detail
