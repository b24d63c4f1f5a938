#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "c/orchard_c.h"
#include "execution/guarded.h"
#include "orchard/runtime/self_collision.h"

namespace rt = orchard::runtime;

struct orchard_self_collision {
  orchard_self_collision(const orchard_tree* const* trees, size_t count) : parts(prepared(trees, count)), self(parts) {
    poses.resize(count);
  }
  static std::vector<rt::PreparedTree> prepared(const orchard_tree* const* trees, size_t count) {
    std::vector<rt::PreparedTree> parts;
    parts.reserve(count);
    for (const orchard_tree* tree : std::span(trees, count)) parts.push_back(tree->prepared);
    return parts;
  }
  std::span<const rt::Pose> placed(const orchard_pose* from) noexcept {
    for (size_t i = 0; i < poses.size(); ++i) poses[i] = rt::detail::pose_of(from[i]);
    return poses;
  }

  std::vector<rt::PreparedTree> parts;
  rt::SelfCollision self;
  std::vector<rt::Pose> poses;  // of the present query
};

namespace {

orchard_touch touch_of(const rt::SelfCollision::Touch& from) noexcept {
  orchard_touch result{};
  result.answer = static_cast<orchard_answer>(from.answer);
  result.part_a = from.part_a;
  result.part_b = from.part_b;
  rt::detail::put_contact(from.contact, result);
  return result;
}

}  // namespace

extern "C" {

orchard_self_collision* orchard_self_collision_new(const orchard_tree* const* parts, size_t count) {
  return rt::detail::guarded([&] { return std::make_unique<orchard_self_collision>(parts, count).release(); },
                             []() -> orchard_self_collision* { return nullptr; });
}

void orchard_self_collision_free(orchard_self_collision* self) { delete self; }

int orchard_self_collision_allow(orchard_self_collision* self, size_t a, size_t b, int allowed) {
  const size_t parts = self->parts.size();
  if (a >= parts || b >= parts) return 0;
  self->self.allowed.allow(a, b, allowed != 0);
  return 1;
}

void orchard_self_collision_allow_touching(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses) {
  self->self.allow_touching(rt::detail::workspace_of(workspace), self->placed(poses));
}

orchard_touch orchard_self_collision_first(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses) {
  return touch_of(self->self.first(rt::detail::workspace_of(workspace), self->placed(poses)));
}

size_t orchard_self_collision_all(orchard_self_collision* self, orchard_workspace* workspace, const orchard_pose* poses,
                                  orchard_touch* touches, size_t room) {
  size_t count = 0;
  self->self.each(rt::detail::workspace_of(workspace), self->placed(poses), [&](const rt::SelfCollision::Touch& touch) {
    if (count < room) touches[count] = touch_of(touch);
    ++count;
    return true;
  });
  return count;
}

}  // extern "C"
