// cuRobo's YAML and XRDF.
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "robot/format_text.h"

namespace orchard::robot {
namespace {

constexpr double kUsualAcceleration = 15, kUsualJerk = 500;  // cuRobo's own defaults
constexpr const char* kAssumedLimit =
    "ASSUMED: a URDF has no such limit; give that of the robot by --acceleration and --jerk";

// A document that is written from the top down. Numbers come as text, so that floats stay floats.
class Yaml {
 public:
  explicit Yaml(std::string head) : text_(std::move(head)) { out_.SetIndent(2); }

  Yaml& begin() { return out_ << YAML::BeginMap, *this; }
  Yaml& end() { return out_ << YAML::EndMap, *this; }
  Yaml& key(const std::string& name) { return out_ << YAML::Key << word(name) << YAML::Value, *this; }
  Yaml& raw(const std::string& value) { return out_ << value, *this; }
  Yaml& name(const std::string& value) { return out_ << word(value), *this; }
  Yaml& comment(const std::string& value) { return out_ << YAML::Comment(value), *this; }
  Yaml& comment_line(const std::string& value) { return out_ << YAML::Newline << YAML::Comment(value), *this; }
  Yaml& names(const std::vector<std::string>& values) {
    out_ << YAML::BeginSeq;
    for (const std::string& value : values) name(value);
    out_ << YAML::EndSeq;
    return *this;
  }
  Yaml& numbers(const std::vector<double>& values) {
    out_ << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) out_ << float_text(value);
    out_ << YAML::EndSeq;
    return *this;
  }
  Yaml& spheres(const std::vector<Sphere>& spheres) {
    out_ << YAML::BeginSeq;
    for (const Sphere& sphere : spheres) {
      begin().key("center").numbers({sphere.center.x(), sphere.center.y(), sphere.center.z()});
      key("radius").raw(float_text(sphere.radius)).end();
    }
    out_ << YAML::EndSeq;
    return *this;
  }
  std::string text() const { return text_ + out_.c_str() + "\n"; }

 private:
  // Names that a reader could take for a number, a truth value or nothing are quoted.
  struct Word {
    std::string text;
    bool quoted;
    friend YAML::Emitter& operator<<(YAML::Emitter& out, const Word& word) {
      if (word.quoted) out << YAML::DoubleQuoted;
      return out << word.text;
    }
  };
  static Word word(const std::string& name) {
    const YAML::Node node(name);
    double number = 0;
    bool truth = false;
    const bool quoted = name.empty() || YAML::convert<double>::decode(node, number) ||
                        YAML::convert<bool>::decode(node, truth) || name == "null" || name == "~" ||
                        std::string("0123456789+-.").find(name.front()) != std::string::npos;
    return {name, quoted};
  }

  YAML::Emitter out_;
  std::string text_;
};

std::vector<std::string> names_of(const SphereModel& model) {
  std::vector<std::string> names;
  for (const apps::SphereGroup& group : model.groups) names.push_back(group.name);
  return names;
}

std::string root_of(const Robot& robot) {
  for (Index link = 0; link < robot.links.size(); ++link)
    if (!robot.joint_above(link)) return robot.links[link].name;
  return {};
}

void write_ignored(const SphereModel& model, Yaml& yaml) {
  yaml.begin();
  for (const auto& [link, others] : ignored_links(model)) yaml.key(link).names(others);
  yaml.end();
}

std::string self_note(const SphereModel& model) {
  return "Pairs that need no test, " + (model.self ? model.self->in_words() : "not sampled: --states N does");
}

void write_cspace(const SphereModel& model, const FormatOptions& options, const char* rest, Yaml& yaml) {
  const std::vector<RestingJoint> joints = resting_joints(model, options);
  std::vector<std::string> names;
  std::vector<double> positions;
  for (const RestingJoint& joint : joints) {
    names.push_back(joint.name);
    positions.push_back(joint.position);
  }
  const std::vector<double> ones(joints.size(), 1);
  yaml.key("cspace").begin().key("joint_names").names(names).key(rest).numbers(positions);
  yaml.key("null_space_weight").numbers(ones).key("cspace_distance_weight").numbers(ones);
  yaml.key("max_acceleration").raw(float_text(options.max_acceleration.value_or(kUsualAcceleration)));
  if (!options.max_acceleration) yaml.comment(kAssumedLimit);
  yaml.key("max_jerk").raw(float_text(options.max_jerk.value_or(kUsualJerk)));
  if (!options.max_jerk) yaml.comment(kAssumedLimit);
  yaml.end();
}

std::string curobo(const SphereModel& model, const FormatOptions& options, bool newest) {
  const Robot& robot = *model.robot;
  const std::vector<std::string> links = names_of(model), tools = tool_frames(model, options);
  Yaml yaml(comments(model, "# "));
  yaml.begin().key("robot_cfg").begin().key("kinematics").begin();
  if (newest) yaml.key("format_version").raw("2.0");
  yaml.key("urdf_path").name(robot.file.filename().string());
  yaml.key("asset_root_path").name(".").key("base_link").name(root_of(robot));
  if (newest)
    yaml.key("tool_frames").names(tools);
  else
    yaml.key("ee_link").name(tools.front());
  yaml.key("collision_link_names").names(links).key("mesh_link_names").names(links);
  yaml.key("collision_sphere_buffer").raw(float_text(model.buffer));
  yaml.key("self_collision_buffer").begin();
  for (const std::string& link : links) yaml.key(link).raw("0.0");
  yaml.end().comment_line(self_note(model)).key("self_collision_ignore");
  write_ignored(model, yaml);
  write_cspace(model, options, newest ? "default_joint_position" : "retract_config", yaml);
  yaml.key("collision_spheres").begin();
  for (const apps::SphereGroup& group : model.groups) yaml.key(group.name).spheres(group.spheres);
  yaml.end().end().end().end();
  return yaml.text();
}

}  // namespace

Files write_curobo(const SphereModel& model, const FormatOptions& options) {
  return {{options.prefix + "-curobo.yml", curobo(model, options, true), "for cuRobo 0.8"}};
}

Files write_curobo07(const SphereModel& model, const FormatOptions& options) {
  return {{options.prefix + "-curobo07.yml", curobo(model, options, false), "for cuRobo 0.7"}};
}

Files write_xrdf(const SphereModel& model, const FormatOptions& options) {
  const std::string geometry = options.prefix + "_collision_spheres";
  const std::vector<RestingJoint> joints = resting_joints(model, options);
  std::vector<std::string> names;
  names.reserve(joints.size());
  for (const RestingJoint& joint : joints) names.push_back(joint.name);
  Yaml yaml(comments(model, "# "));
  yaml.begin().key("format").raw("xrdf").key("format_version").raw("1.0");
  yaml.key("default_joint_positions").begin();
  for (const RestingJoint& joint : joints) yaml.key(joint.name).raw(float_text(joint.position));
  yaml.end().key("cspace").begin().key("joint_names").names(names);
  yaml.key("acceleration_limits");
  yaml.numbers(std::vector<double>(joints.size(), options.max_acceleration.value_or(kUsualAcceleration)));
  if (!options.max_acceleration) yaml.comment(kAssumedLimit);
  yaml.key("jerk_limits").numbers(std::vector<double>(joints.size(), options.max_jerk.value_or(kUsualJerk)));
  if (!options.max_jerk) yaml.comment(kAssumedLimit);
  yaml.end().key("tool_frames").names(tool_frames(model, options));
  yaml.key("collision").begin().key("geometry").name(geometry).key("buffer_distance").begin();
  for (const apps::SphereGroup& group : model.groups)
    if (model.buffer != 0) yaml.key(group.name).raw(float_text(model.buffer));
  yaml.end().end().key("self_collision").begin().key("geometry").name(geometry);
  yaml.key("buffer_distance").begin().end().comment_line(self_note(model)).key("ignore");
  write_ignored(model, yaml);
  yaml.end().key("geometry").begin().key(geometry).begin().key("spheres").begin();
  for (const apps::SphereGroup& group : model.groups) yaml.key(group.name).spheres(group.spheres);
  yaml.end().end().end().end();
  return {{options.prefix + ".xrdf", yaml.text(), "for Isaac and cuMotion"}};
}

}  // namespace orchard::robot
