#pragma once
#include <span>

#include "forming_points.h"
#include "workspace.h"

// What points do to a plane or a sphere, found by looking at each of them.
namespace orchard::detail {

// How far the farthest of some points lies beyond the hull's facet of a vertex at infinity; `diameter`, that of the
// points, where the facet is too thin to tell. O(n).
double farthest_beyond(const Workspace& workspace, Index vertex, std::span<const Index> points, double diameter);

// How deep the deepest of the points that form vertices lies in the sphere of a vertex's forming points, in terms of a
// sphere no larger than the points' own; `diameter` where the vertex is too flat to tell. O(n); parallel.
double deepest_within(const Workspace& workspace, Index vertex, const FormingPoints& forming, double diameter);

}  // namespace orchard::detail
