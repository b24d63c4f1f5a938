#pragma once
#include <cstdint>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::apps {

// The ball of the root, in the frame of the tree.
struct RootBall {
  runtime::Vec3 center;
  double radius = 0;
};
RootBall root_ball(const runtime::TreeView& tree);

struct PosePair {
  runtime::Pose a, b;
};

// Returns poses like those that a narrow phase has to answer for: not random ones, but of bodies that approach each
// other or just meet (dissertation 7.2). Each flight rotates both bodies at random, and moves the second one along a
// random line. The line meets, at a uniformly distributed point, the disk around the first body's centre in which the
// bounding spheres can meet. There is a pose after each sixteenth of the sum of the radii, as long as the bounding
// spheres overlap, up to and including the first pose at which the bodies touch. A flight may have no pose. The result
// for a seed is the same on every machine.
std::vector<PosePair> flight_poses(const runtime::TreeView& a, const runtime::TreeView& b, unsigned flights,
                                   std::uint64_t seed);

}  // namespace orchard::apps
