#include "robot/urdf_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "input/xml_file.h"
#include "orchard/geometry/error.h"
#include "robot/urdf_values.h"

namespace orchard::robot {
namespace {

using apps::at_line;
using apps::children_of;
using tinyxml2::XMLElement;

constexpr std::array<std::pair<const char*, JointKind>, 6> kKinds{{{"fixed", JointKind::fixed},
                                                                   {"revolute", JointKind::revolute},
                                                                   {"continuous", JointKind::continuous},
                                                                   {"prismatic", JointKind::prismatic},
                                                                   {"floating", JointKind::floating},
                                                                   {"planar", JointKind::planar}}};

JointKind kind_of(const XMLElement& joint, const Robot& robot) {
  const std::string type = required(joint, "type", robot.file);
  for (const auto& [name, kind] : kKinds)
    if (type == name) return kind;
  throw InputError(fmt::format("{}: {} is no type of joint", at_line(robot.file, joint), type));
}

Index link_of(const XMLElement& joint, const char* end, const Robot& robot) {
  const XMLElement* element = joint.FirstChildElement(end);
  if (element == nullptr) throw InputError(fmt::format("{}: a joint has no <{}>", at_line(robot.file, joint), end));
  const std::string name = required(*element, "link", robot.file);
  if (const auto link = robot.find_link(name)) return *link;
  throw InputError(fmt::format("{}: there is no link {}", at_line(robot.file, *element), name));
}

void read_limits(const XMLElement& element, Joint& joint, Robot& robot) {
  const bool bounded = joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
  const XMLElement* limit = element.FirstChildElement("limit");
  if (limit != nullptr) {
    joint.limits = JointLimits{.lower = number(*limit, "lower", 0, robot.file),
                               .upper = number(*limit, "upper", 0, robot.file),
                               .velocity = number(*limit, "velocity", 0, robot.file),
                               .effort = number(*limit, "effort", 0, robot.file)};
    if (bounded && joint.limits->lower > joint.limits->upper)
      throw InputError(fmt::format("{}: the lower limit is above the upper one", at_line(robot.file, *limit)));
  } else if (bounded) {
    const bool turns = joint.kind == JointKind::revolute;
    joint.limits = JointLimits{};
    if (turns) joint.limits = JointLimits{.lower = -std::numbers::pi, .upper = std::numbers::pi};
    robot.notes.push_back(fmt::format("{}: joint {} has no limits, which the standard asks for: taken as {}",
                                      at_line(robot.file, element), joint.name, turns ? "-pi to pi" : "0 to 0"));
  }
}

Joint read_joint(const XMLElement& element, Robot& robot) {
  Joint joint;
  joint.name = required(element, "name", robot.file);
  joint.line = element.GetLineNum();
  if (robot.find_joint(joint.name))
    throw InputError(fmt::format("{}: there is already a joint {}", at_line(robot.file, element), joint.name));
  joint.kind = kind_of(element, robot);
  joint.parent = link_of(element, "parent", robot);
  joint.child = link_of(element, "child", robot);
  joint.origin = read_origin(element, robot.file);
  if (const XMLElement* axis = element.FirstChildElement("axis"); axis != nullptr) {
    joint.axis = vector(*axis, "xyz", Vector::UnitX(), robot.file);
    if (joint.axis.norm() == 0 && joint.moves())
      throw InputError(at_line(robot.file, *axis) + ": the axis has length 0");
    if (joint.moves()) joint.axis.normalize();
  }
  read_limits(element, joint, robot);
  if (joint.kind == JointKind::floating || joint.kind == JointKind::planar)
    robot.notes.push_back(fmt::format("{}: joint {} is {}: its link stays at its origin", at_line(robot.file, element),
                                      joint.name, element.Attribute("type")));
  return joint;
}

void read_mimics(const std::vector<const XMLElement*>& elements, Robot& robot) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const XMLElement* mimic = elements[i]->FirstChildElement("mimic");
    if (mimic == nullptr) continue;
    const std::string name = required(*mimic, "joint", robot.file);
    const auto leader = robot.find_joint(name);
    if (!leader) throw InputError(fmt::format("{}: there is no joint {}", at_line(robot.file, *mimic), name));
    robot.joints[i].mimic = Mimic{.joint = *leader,
                                  .multiplier = number(*mimic, "multiplier", 1, robot.file),
                                  .offset = number(*mimic, "offset", 0, robot.file)};
  }
  for (const Joint& joint : robot.joints) {
    const Joint* at = &joint;
    for (std::size_t steps = 0; at->mimic; ++steps, at = &robot.joints[at->mimic->joint])
      if (steps > robot.joints.size())
        throw InputError(fmt::format("{}, line {}: joint {} mimics itself through others", robot.file.string(),
                                     joint.line, joint.name));
  }
}

// Every link has one parent at most, so a loop is a way up that does not end.
void refuse_loops(const Robot& robot) {
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (robot.joints[k].child == robot.joints[i].child)
        throw InputError(fmt::format("{}, line {}: link {} has two parents, by the joints {} and {}",
                                     robot.file.string(), robot.joints[i].line, robot.links[robot.joints[i].child].name,
                                     robot.joints[k].name, robot.joints[i].name));
  for (const Joint& joint : robot.joints) {
    Index link = joint.parent;
    for (std::size_t steps = 0; const auto above = robot.joint_above(link); ++steps) {
      if (steps > robot.joints.size())
        throw InputError(fmt::format("{}, line {}: joint {} is part of a loop of joints, which URDF does not have",
                                     robot.file.string(), joint.line, joint.name));
      link = robot.joints[*above].parent;
    }
  }
}

void note_roots(Robot& robot) {
  std::vector<std::string> roots;
  for (Index link = 0; link < robot.links.size(); ++link)
    if (!robot.joint_above(link)) roots.push_back(robot.links[link].name);
  if (roots.size() > 1)
    robot.notes.push_back(fmt::format("{}: {} links hang on no joint, and are placed at the origin: {}",
                                      robot.file.string(), roots.size(), fmt::join(roots, ", ")));
}

}  // namespace

void read_joints(const XMLElement& root, Robot& robot) {
  const std::vector<const XMLElement*> elements = children_of(root, "joint");
  for (const XMLElement* element : elements) robot.joints.push_back(read_joint(*element, robot));
  read_mimics(elements, robot);
  refuse_loops(robot);
  note_roots(robot);
}

}  // namespace orchard::robot
