// Does a robot touch itself? An arm of six links, a tree each; pairs that touch at rest, or always do as neighbours,
// are allowed, all others are not. The arm curls up until two links meet.
//   robot link.orchard
#include <cmath>
#include <cstdio>
#include <vector>

#include "orchard/runtime/self_collision.h"
#include "orchard/runtime/tree_file.h"

using namespace orchard::runtime;

namespace {

constexpr std::size_t kLinks = 6;

// Where the links are when all joints turn by the same angle.
std::vector<Pose> posture(double angle, double length) {
  const Pose joint = *pose_from_quaternion({std::cos(angle / 2), 0, 0, std::sin(angle / 2)}, {length, 0, 0});
  std::vector<Pose> poses = {Pose{}};
  while (poses.size() < kLinks) poses.push_back(compose(poses.back(), joint));
  return poses;
}

}  // namespace

int main(int argc, char** argv) {
  PackedSphereTree link;
  const LoadStatus status = argc == 2 ? load_file(argv[1], link) : LoadStatus::cannot_open;
  if (status != LoadStatus::ok) {
    std::fprintf(stderr, "usage: robot link.orchard (%s)\n", message(status));
    return 2;
  }
  const double length = 2.1 * link.bounding_radius;
  const std::vector<Pose> rest = posture(0, length);
  const std::vector<PreparedTree> links(kLinks, PreparedTree(link));
  SelfCollision arm(links);
  Workspace workspace;
  for (std::size_t i = 0; i + 1 < kLinks; ++i) arm.allow(i, i + 1);  // neighbours share a joint
  arm.allow_touching(workspace, rest);
  std::size_t checked = 0;
  for (std::size_t a = 0; a < kLinks; ++a) {
    for (std::size_t b = a + 1; b < kLinks; ++b) checked += !arm.allows(a, b);
  }
  std::printf("%zu of %zu pairs of links are checked\n", checked, kLinks * (kLinks - 1) / 2);

  for (double angle = 0; angle < 1.3; angle += 0.01) {
    const SelfCollision::Touch touch = arm.first(workspace, posture(angle, length));
    if (touch.answer != Answer::yes) continue;
    const auto at = touch.contact.center;
    std::printf("with its joints at %.2f rad link %zu touches link %zu at (%.3g, %.3g, %.3g)\n", angle, touch.part_a,
                touch.part_b, at[0], at[1], at[2]);
    return angle > 0 ? 0 : 1;
  }
  std::printf("the arm never touches itself\n");
  return 1;
}
