#pragma once
#include <span>
#include <vector>

#include "workspace/forming_points.h"
#include "workspace/workspace.h"

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

// Blocks of points that follow each other in the order of insertion, in which most are neighbours in space, with a box
// around each: a sphere that is empty, or nearly, reaches into few of them. For the points of one workspace.
class PointBlocks {
 public:
  explicit PointBlocks(std::span<const Point> points);

  // How deep the deepest of the points that form vertices lies in the sphere of a vertex's forming points, in terms of
  // a sphere no larger than the points' own; `diameter`, and no point, where the vertex is too flat to tell. O(n) at
  // most, mostly less.
  Intruder deepest_within(const Workspace& workspace, Index vertex, const FormingPoints& forming,
                          double diameter) const;

 private:
  std::vector<Box> boxes_;
};

}  // namespace orchard::detail
