#pragma once
#include <span>

#include "forming_points.h"
#include "workspace.h"

// What points do to a plane or a sphere, found by looking at each of them.
namespace orchard::detail {

// A point and how far it is beyond a plane or how deep in a sphere; none if there is no such point.
struct Intruder {
  double depth = 0;
  Index point = kNone;
};

// How far the farthest of some points lies beyond the hull's facet of a vertex at infinity; `diameter`, that of the
// points, and no point, where the facet is too thin to tell. O(n).
Intruder farthest_beyond(const Workspace& workspace, Index vertex, std::span<const Index> points, double diameter);

// How deep the deepest of the points that form vertices lies in the sphere of a vertex's forming points, in terms of a
// sphere no larger than the points' own; `diameter`, and no point, where the vertex is too flat to tell. O(n);
// parallel.
Intruder deepest_within(const Workspace& workspace, Index vertex, const FormingPoints& forming, double diameter);

}  // namespace orchard::detail
