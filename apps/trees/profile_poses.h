#pragma once
#include <cstdint>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::apps {

// The root's ball, in the tree's own frame.
struct RootBall {
  runtime::Vec3 center;
  double radius = 0;
};
RootBall root_ball(const runtime::TreeView& tree);

struct PosePair {
  runtime::Pose a, b;
};

// Poses as a narrow phase is asked about (dissertation 7.2: not random ones, but of bodies that draw near or just
// meet): each flight turns both bodies at random and takes the second one along a random line whose distance from the
// first one's centre is that of a point spread evenly over the disk in which the bounding spheres can meet. One pose a
// sixteenth of the radii's sum, as long as these overlap, until the first that touches, which is kept. The same for a
// seed on every machine. Flights that end before their first pose leave none.
std::vector<PosePair> flight_poses(const runtime::TreeView& a, const runtime::TreeView& b, unsigned flights,
                                   std::uint64_t seed);

}  // namespace orchard::apps
