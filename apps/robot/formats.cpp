#include "robot/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "orchard/geometry/error.h"
#include "robot/format_text.h"
#include "robot/kinematics.h"

namespace orchard::robot {
namespace {

constexpr std::array<Format, 15> kFormats{{
    {"curobo", "cuRobo 0.8, YAML with format_version 2.0", write_curobo},
    {"curobo07", "cuRobo 0.7, YAML", write_curobo07},
    {"xrdf", "XRDF 1.0, of Isaac and cuMotion", write_xrdf},
    {"srdf", "SRDF of MoveIt: link_sphere_approximation and disable_collisions", write_srdf},
    {"urdf", "URDF whose collision geometry is the spheres", write_urdf},
    {"vamp", "VAMP: the JSON that its generator reads, with that URDF and SRDF", write_vamp},
    {"mjcf", "MJCF of MuJoCo: a body for each link", write_mjcf},
    {"ballpark", "ballpark: JSON of centers and radii by link", write_ballpark},
    {"morphit", "MorphIt: JSON for each mesh, in its frame, with masses", write_morphit},
    {"foam", "foam: JSON for each link", write_foam},
    {"csv", "a table of x, y, z, r and the link", write_csv},
    {"json", "JSON with everything", write_json},
    {"liggghts", "LIGGGHTS: multisphere files for each link and an include file", write_liggghts},
    {"lammps", "LAMMPS: a molecule for each link", write_lammps},
    {"yade", "YADE: a script that makes clumps", write_yade},
}};

// From the frame of the group's spheres to the link's; the scale is that of the radii.
std::pair<Motion, double> frame_of(const apps::SphereGroup& group, const Link& link,
                                   const std::filesystem::path& file) {
  if (group.element >= link.collision.size()) {
    // Spheres of a link without geometry have no element whose frame they could be in.
    if (group.frame == apps::SphereFrame::element && link.collision.empty()) return {Motion::Identity(), 1};
    throw InputError(fmt::format("{}: link {} has no collision element {} (they count from 0)", file.string(),
                                 link.name, group.element));
  }
  const Element& element = link.collision[group.element];
  if (group.frame == apps::SphereFrame::element) return {element.origin, 1};
  const Vector size = element.scale.cwiseAbs();
  if (size.maxCoeff() - size.minCoeff() > 1e-12 * size.maxCoeff())
    throw InputError(fmt::format("{}: link {}: the mesh is scaled unevenly, so its spheres would not be round",
                                 file.string(), link.name));
  return {element.origin, size.x()};
}

void move_to_link(apps::SphereGroup& group, const Link& link, const std::filesystem::path& file) {
  if (group.frame == apps::SphereFrame::link) return;
  const auto [motion, scale] = frame_of(group, link, file);
  const bool of_mesh = group.frame == apps::SphereFrame::mesh;
  for (Sphere& sphere : group.spheres) {
    if (of_mesh) sphere.center = link.collision[group.element].scale.cwiseProduct(sphere.center);
    sphere.center = motion * sphere.center;
    sphere.radius *= scale;
  }
  group.frame = apps::SphereFrame::link;
}

void append(const apps::SphereGroup& more, apps::SphereGroup& group) {
  group.spheres.insert(group.spheres.end(), more.spheres.begin(), more.spheres.end());
  group.masses.insert(group.masses.end(), more.masses.begin(), more.masses.end());
  group.switched_off += more.switched_off;
}

// How many joints that move lie above a link.
Index depth_of(const Robot& robot, Index link) {
  Index depth = 0;
  while (const auto joint = robot.joint_above(link)) {
    if (robot.joints[*joint].moves()) ++depth;
    link = robot.joints[*joint].parent;
  }
  return depth;
}

}  // namespace

std::span<const Format> formats() { return kFormats; }

std::vector<FormatFile> write_format(const std::string& format, const SphereModel& model,
                                     const FormatOptions& options) {
  const auto found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& one) { return format == one.name; });
  return found->write(model, options);
}

std::vector<std::string> place_in_links(const Robot& robot, apps::SphereFile& spheres,
                                        const std::filesystem::path& file) {
  std::vector<std::string> notes;
  std::vector<apps::SphereGroup> joined;  // files with a file a mesh have several groups for a link
  for (apps::SphereGroup& group : spheres.groups) {
    const auto link = robot.find_link(group.name);
    if (!link) {
      notes.push_back(fmt::format("{}: {} spheres of {} are left out: {} has no such link", file.string(),
                                  group.spheres.size() + group.switched_off, group.name, robot.file.string()));
      continue;
    }
    move_to_link(group, robot.links[*link], file);
    const auto same =
        std::find_if(joined.begin(), joined.end(), [&](const auto& one) { return one.name == group.name; });
    if (same == joined.end())
      joined.push_back(std::move(group));
    else
      append(group, *same);
  }
  std::stable_sort(joined.begin(), joined.end(),
                   [&](const auto& a, const auto& b) { return *robot.find_link(a.name) < *robot.find_link(b.name); });
  spheres.groups = std::move(joined);
  return notes;
}

std::string float_text(double value) {
  std::string text = fmt::format("{}", value == 0 ? 0.0 : value);  // no -0
  if (text.find('.') != std::string::npos) return text;
  const std::size_t exponent = text.find('e');
  return text.insert(std::min(exponent, text.size()), ".0");
}

std::string point_text(const Point& point, const char* between) {
  return float_text(point.x()) + between + float_text(point.y()) + between + float_text(point.z());
}

std::vector<std::string> file_stems(const SphereModel& model) {
  std::vector<std::string> stems;
  std::set<std::string> taken;
  for (const apps::SphereGroup& group : model.groups) {
    std::string stem = group.name;
    for (char& c : stem)
      if (c == '/' || c == '\\' || std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '_';
    while (!taken.insert(stem).second) stem += "x";
    stems.push_back(stem);
  }
  return stems;
}

std::string comments(const SphereModel& model, const char* mark) {
  std::string text;
  for (const std::string& line : model.head) text += mark + line + "\n";
  return text;
}

std::string harmless(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.replace(at, 2, "- -");
  return text;
}

std::vector<std::string> tool_frames(const SphereModel& model, const FormatOptions& options) {
  if (!options.tool_frames.empty()) return options.tool_frames;
  const Robot& robot = *model.robot;
  Index deepest = 0;
  for (Index link = 0; link < robot.links.size(); ++link)
    if (depth_of(robot, link) > depth_of(robot, deepest)) deepest = link;
  return {robot.links[deepest].name};
}

std::vector<std::pair<std::string, std::vector<std::string>>> ignored_links(const SphereModel& model) {
  std::vector<std::pair<std::string, std::vector<std::string>>> ignored;
  if (!model.self) return ignored;
  for (const LinkPair& pair : model.self->pairs) {  // ordered by the first
    if (!pair.ignored()) continue;
    const std::string& link = model.robot->links[pair.a].name;
    if (ignored.empty() || ignored.back().first != link) ignored.push_back({link, {}});
    ignored.back().second.push_back(model.robot->links[pair.b].name);
  }
  return ignored;
}

std::vector<RestingJoint> resting_joints(const SphereModel& model, const FormatOptions& options) {
  const JointValues values = joint_values(*model.robot, options.positions);
  std::vector<RestingJoint> joints;
  for (const Index joint : model.robot->free_joints())
    joints.push_back({model.robot->joints[joint].name, values[joint]});
  return joints;
}

}  // namespace orchard::robot
