#include "robot/robot.h"

namespace orchard::robot {
namespace {

template <class Named>
std::optional<Index> find(const std::vector<Named>& all, std::string_view name) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return static_cast<Index>(i);
  return std::nullopt;
}

}  // namespace

std::optional<Index> Robot::find_link(std::string_view link) const { return find(links, link); }
std::optional<Index> Robot::find_joint(std::string_view joint) const { return find(joints, joint); }

std::optional<Index> Robot::joint_above(Index link) const {
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].child == link) return static_cast<Index>(i);
  return std::nullopt;
}

std::vector<Index> Robot::free_joints() const {
  std::vector<Index> free;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointKind kind = joints[i].kind;
    const bool one = kind == JointKind::revolute || kind == JointKind::continuous || kind == JointKind::prismatic;
    if (one && !joints[i].mimic) free.push_back(static_cast<Index>(i));
  }
  return free;
}

}  // namespace orchard::robot
