#pragma once
#include <span>
#include <vector>

#include "workspace/forming_points.h"
#include "workspace/workspace.h"

// The point farthest beyond a plane, and the point deepest in a sphere, found by looking at the points one by one.
namespace orchard::detail {

// A point and its distance beyond a plane or its depth in a sphere. No point is beyond or inside if `point` is kNone
// and `depth` is 0.
struct Intruder {
  double depth = 0;
  Index point = kNone;
};

// The point that lies farthest beyond the convex hull's facet that belongs to a vertex at infinity, among `points`.
// Where the facet is too thin for its normal to be known, the depth is `diameter` (that of all points) and the point
// is kNone. O(n).
Intruder farthest_beyond(const Workspace& workspace, Index vertex, std::span<const Index> points, double diameter);

// The points of one workspace in blocks of consecutive points, with a box around each block. Points that follow each
// other in the order of insertion are mostly neighbours in space, so a sphere with no or few points inside reaches into
// few of the boxes.
class PointBlocks {
 public:
  explicit PointBlocks(std::span<const Point> points);

  // The deepest point, among those that form vertices, in the sphere through a vertex's forming points. Its depth is
  // the negative power divided by the sphere's radius or half the diameter of the points, whichever is less. Where the
  // forming points are too flat for the centre to be known, the depth is `diameter` and the point is kNone. O(n) at
  // most, mostly less.
  Intruder deepest_within(const Workspace& workspace, Index vertex, const FormingPoints& forming,
                          double diameter) const;

 private:
  std::vector<Box> boxes_;
};

}  // namespace orchard::detail
