#include "orchard/runtime/self_collision.h"

namespace orchard::runtime {

void SelfCollision::allow_touching(Workspace& workspace, std::span<const Pose> poses) noexcept {
  each(workspace, poses, [this](const Touch& touch) {
    allow(touch.part_a, touch.part_b);
    return true;
  });
}

SelfCollision::Touch SelfCollision::first(Workspace& workspace, std::span<const Pose> poses) const noexcept {
  Touch result;
  each(workspace, poses, [&result](const Touch& touch) {
    if (result.answer == Answer::no || touch.answer == Answer::yes) result = touch;
    return touch.answer != Answer::yes;
  });
  return result;
}

}  // namespace orchard::runtime
