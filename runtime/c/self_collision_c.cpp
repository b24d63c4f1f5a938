#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "c/orchard_c.h"
#include "orchard/runtime/self_collision.h"

namespace rt = orchard::runtime;
namespace {

using namespace rt::detail;
static_assert(sizeof(orchard_touch) == sizeof(rt::SelfCollision::Touch));

}  // namespace

struct orchard_self_collision {
  explicit orchard_self_collision(std::vector<rt::PreparedTree> trees)
      : parts(std::move(trees)), self(parts), poses(parts.size()) {}
  std::span<const rt::Pose> placed(const orchard_pose* from) noexcept {
    std::transform(from, from + poses.size(), poses.begin(), pose_of);
    return poses;
  }

  std::vector<rt::PreparedTree> parts;
  rt::SelfCollision self;
  std::vector<rt::Pose> poses;  // of the present query
};

extern "C" {

orchard_self_collision* orchard_self_collision_new(const orchard_tree* const* parts, size_t count) {
  return made_or<orchard_self_collision*>(nullptr, [&] {
    std::vector<rt::PreparedTree> trees;
    for (const orchard_tree* tree : std::span(parts, count)) trees.push_back(tree->prepared);
    return new orchard_self_collision(std::move(trees));
  });
}

void orchard_self_collision_free(orchard_self_collision* self) { delete self; }

int orchard_self_collision_allow(orchard_self_collision* self, size_t a, size_t b, int allowed) {
  const size_t parts = self->parts.size();
  if (a >= parts || b >= parts) return 0;
  self->self.allow(a, b, allowed != 0);
  return 1;
}

void orchard_self_collision_allow_touching(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses) {
  self->self.allow_touching(workspace->workspace, self->placed(poses));
}

orchard_touch orchard_self_collision_first(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses) {
  return converted<orchard_touch>(self->self.first(workspace->workspace, self->placed(poses)));
}

size_t orchard_self_collision_all(orchard_self_collision* self, orchard_workspace* workspace, const orchard_pose* poses,
                                  orchard_touch* touches, size_t room) {
  size_t count = 0;
  self->self.each(workspace->workspace, self->placed(poses), [&](const rt::SelfCollision::Touch& touch) {
    if (count < room) touches[count] = converted<orchard_touch>(touch);
    ++count;
    return true;
  });
  return count;
}

}  // extern "C"
