#include "robot/formats.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "robot/urdf_reader.h"

namespace orchard::robot {
namespace {

using apps::SphereFile;
using apps::SphereGroup;
using test::Workplace;

const char* const kRobot =
    "<robot name='two arms'>\n"
    "<link name='base'><inertial><origin xyz='0 0 0.1' rpy='0 0 1.5707963267948966'/><mass value='2'/>"
    "<inertia ixx='3' iyy='4' izz='5' ixy='0.1' ixz='0.2' iyz='0.3'/></inertial>"
    "<collision><geometry><box size='1 1 1'/></geometry></collision></link>\n"
    "<link name='arm, \"left\" #1'>"
    "<collision><origin xyz='0.1 0.2 0.3' rpy='0.4 -0.5 1.2'/><geometry><box size='1 1 1'/></geometry></collision>"
    "<collision><origin xyz='2 0 0' rpy='1 0.3 0'/><geometry><box size='1 1 1'/></geometry></collision></link>\n"
    "<link name='123'><collision><geometry><sphere radius='0.2'/></geometry></collision></link>\n"
    "<link name='tool'/>\n"
    "<joint name='turn' type='revolute'><parent link='base'/><child link='arm, \"left\" #1'/><axis xyz='0 0 1'/>"
    "<limit lower='0.5' upper='1' effort='1' velocity='1'/></joint>\n"
    "<joint name='slide' type='prismatic'><parent link='arm, \"left\" #1'/><child link='123'/><axis xyz='0 0 2'/>"
    "<limit lower='-1' upper='1' effort='1' velocity='1'/><mimic joint='turn' multiplier='-0.5' "
    "offset='0.25'/></joint>\n"
    "<joint name='end' type='fixed'><parent link='123'/><child link='tool'/></joint></robot>";

// Spheres whose numbers are awkward: whole, below 0, and so small that they are written with an exponent.
struct Model {
  Workplace here;
  Robot robot = read_urdf(here.add("two arms.urdf", kRobot));
  SphereModel model;

  Model() {
    model.robot = &robot;
    model.head = {"3 links -- a comment", "orchard {\"x\": 1}"};
    const auto add = [&](const char* link, std::vector<Sphere> spheres) {
      SphereGroup group;
      group.name = link;
      group.spheres = std::move(spheres);
      model.groups.push_back(std::move(group));
      model.bodies.push_back({2, Point(0, 0, 0.1), Eigen::Vector3d(4, 3, 5).asDiagonal()});
    };
    add("base", {{Point(0, 0, 0), 1}, {Point(-0.0000003, 0.1234567, 12), 0.0000002}});
    add("arm, \"left\" #1", {{Point(0.1, -0.2, 0.3), 0.4}, {Point(1.9, 0.05, 0), 0.5}});
    add("123", {{Point(1, 2, 3), 0.25}});
    SelfCollision self{.states = 10, .seed = 4, .pairs = {}};
    self.pairs = {
        {0, 1, PairVerdict::adjacent, 10, 10}, {0, 2, PairVerdict::sometimes, 3, 5}, {1, 2, PairVerdict::never, 0, 1}};
    model.self = self;
  }

  // The first of the files that the format's name and these options give.
  std::string write(const std::string& format) const {
    std::string last;
    for (const FormatFile& file : write_format(format, model, {.prefix = "two arms"})) {
      write_file(here / file.name, file.text);
      last = (here / file.name).string();
    }
    return last;
  }
};

void expect_same(const std::vector<SphereGroup>& read, const std::vector<SphereGroup>& written, double within,
                 const std::string& what) {
  ASSERT_EQ(read.size(), written.size()) << what;
  for (std::size_t g = 0; g < read.size(); ++g) {
    EXPECT_EQ(read[g].name, written[g].name) << what;
    ASSERT_EQ(read[g].spheres.size(), written[g].spheres.size()) << what;
    for (std::size_t s = 0; s < read[g].spheres.size(); ++s) {
      EXPECT_LE((read[g].spheres[s].center - written[g].spheres[s].center).norm(), within) << what;
      EXPECT_NEAR(read[g].spheres[s].radius, written[g].spheres[s].radius, within) << what;
    }
  }
}

TEST(Formats, OfRobotsReadBackAsTheSameSpheres) {
  const Model m;
  for (const char* format : {"curobo", "curobo07", "xrdf", "urdf", "vamp", "mjcf", "ballpark", "csv", "json", "srdf"}) {
    std::string file = m.write(format);
    if (format == std::string("vamp")) file = (m.here / "two arms-vamp.json").string();
    SphereFile read = apps::read_sphere_file(file);
    std::erase_if(read.groups, [](const SphereGroup& group) { return group.spheres.empty(); });
    EXPECT_TRUE(place_in_links(m.robot, read, file).empty());
    expect_same(read.groups, m.model.groups, format == std::string("srdf") ? 1e-13 : 0, format);
  }
}

TEST(Formats, OfSingleLinksReadBackAsTheSameSpheres) {
  const Model m;
  for (const char* format : {"foam", "lammps", "liggghts", "yade"}) {
    std::vector<Sphere> all;
    for (const FormatFile& file : write_format(format, m.model, {.prefix = "two arms"})) {
      if (file.name.ends_with(".in")) continue;
      write_file(m.here / file.name, file.text);
      for (const SphereGroup& group : apps::read_sphere_file(m.here / file.name).groups)
        all.insert(all.end(), group.spheres.begin(), group.spheres.end());
    }
    std::size_t at = 0;
    for (const SphereGroup& group : m.model.groups)
      for (const Sphere& sphere : group.spheres) {
        ASSERT_LT(at, all.size()) << format;
        EXPECT_EQ((all[at].center - sphere.center).norm(), 0) << format;
        EXPECT_EQ(all[at++].radius, sphere.radius) << format;
      }
    EXPECT_EQ(at, all.size()) << format;
  }
}

TEST(Formats, OfMorphItAreInTheFramesOfTheMeshes) {
  const Model m;
  m.write("morphit");
  SphereFile read = apps::read_sphere_file(m.here / ".");
  place_in_links(m.robot, read, "folder");
  ASSERT_EQ(read.groups.size(), 3);
  double mass = 0;
  for (const double one : read.groups[0].masses) mass += one;
  EXPECT_NEAR(mass, 2, 1e-12);
  expect_same(read.groups, m.model.groups, 1e-12, "morphit");
}

TEST(Formats, OfSrdfAreInTheFrameOfTheFirstCollisionElement) {
  const Model m;
  const SphereFile read = apps::read_sphere_file(m.write("srdf"));
  for (const SphereGroup& group : read.groups) {
    if (group.name != "arm, \"left\" #1") continue;
    const Motion origin = m.robot.links[1].collision[0].origin;
    for (std::size_t s = 0; s < 2; ++s) {
      EXPECT_LT((origin * group.spheres[s].center - m.model.groups[1].spheres[s].center).norm(), 1e-14);
      EXPECT_GT((group.spheres[s].center - m.model.groups[1].spheres[s].center).norm(), 0.01);
      // As the reader holds it, it holds what was proven.
      EXPECT_GE(group.spheres[s].radius, m.model.groups[1].spheres[s].radius);
    }
  }
}

// Every scalar below a node.
void each_scalar(const YAML::Node& node, const std::function<void(const YAML::Node&)>& visit) {
  if (node.IsScalar()) return visit(node);
  for (const auto& child : node) each_scalar(node.IsMap() ? child.second : YAML::Node(child), visit);
}

TEST(Formats, OfCuroboHaveFloatsForFloatsAndWordsForNames) {
  const Model m;
  for (const char* format : {"curobo", "curobo07"}) {
    const YAML::Node kinematics = YAML::LoadFile(m.write(format))["robot_cfg"]["kinematics"];
    for (const char* key : {"collision_spheres", "self_collision_buffer", "cspace"})
      each_scalar(key == std::string("cspace") ? kinematics[key]["null_space_weight"] : kinematics[key],
                  [](const YAML::Node& value) {
                    EXPECT_NE(value.Scalar().find('.'), std::string::npos) << value.Scalar();
                    EXPECT_NO_THROW(value.as<double>());
                  });
    EXPECT_EQ(kinematics["collision_link_names"][2].Tag(), "!") << "a name of digits is to be quoted";
    EXPECT_EQ(kinematics["cspace"]["joint_names"].size(), 1);
    const bool newest = format == std::string("curobo");
    EXPECT_EQ(kinematics["format_version"].IsDefined(), newest);
    EXPECT_EQ(kinematics["tool_frames"].IsDefined(), newest);
    EXPECT_EQ(kinematics["cspace"]["default_joint_position"].IsDefined(), newest);
    EXPECT_EQ(kinematics["cspace"]["retract_config"].IsDefined(), !newest);
    const YAML::Node rest = kinematics["cspace"][newest ? "default_joint_position" : "retract_config"];
    EXPECT_EQ(rest[0].as<double>(), 0.5);  // the nearest to 0 that its limits allow
    EXPECT_EQ(kinematics["self_collision_ignore"]["base"].size(), 1);
    EXPECT_EQ(kinematics["self_collision_ignore"]["arm, \"left\" #1"][0].Scalar(), "123");
  }
}

TEST(Formats, OfXrdfHaveWhatItsReaderRequires) {
  const Model m;
  const std::string file = m.write("xrdf");
  const YAML::Node root = YAML::LoadFile(file);
  EXPECT_EQ(root["format"].Scalar(), "xrdf");
  EXPECT_EQ(root["collision"]["geometry"].Scalar(), root["self_collision"]["geometry"].Scalar());
  EXPECT_TRUE(root["geometry"][root["collision"]["geometry"].Scalar()]["spheres"].IsMap());
  EXPECT_EQ(root["cspace"]["joint_names"].size(), 1);
  EXPECT_EQ(root["cspace"]["acceleration_limits"].size(), 1);
  EXPECT_EQ(root["cspace"]["jerk_limits"].size(), 1);
  EXPECT_EQ(root["default_joint_positions"]["turn"].as<double>(), 0.5);
  EXPECT_EQ(root["tool_frames"][0].Scalar(), "123");
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find("ASSUMED"), std::string::npos);
  const auto stated = write_format("xrdf", m.model, {.prefix = "r", .max_acceleration = 12.5, .max_jerk = 300});
  EXPECT_EQ(stated.front().text.find("ASSUMED"), std::string::npos);
  EXPECT_EQ(YAML::Load(stated.front().text)["cspace"]["jerk_limits"][0].as<double>(), 300);
}

TEST(Formats, OfVampNameAnIdentifierAndItsFiles) {
  const Model m;
  const auto files = write_format("vamp", m.model, {.prefix = "2 arms-v1"});
  ASSERT_EQ(files.size(), 3);
  const auto json = nlohmann::json::parse(files.back().text);
  EXPECT_EQ(json["name"], "R2_arms_v1");
  EXPECT_EQ(json["urdf"], files[0].name);
  EXPECT_EQ(json["srdf"], files[1].name);
  for (const char* key : {"end_effector", "resolution", "template", "subtemplates", "output"})
    EXPECT_TRUE(json.contains(key)) << key;
}

TEST(Formats, OfMjcfGiveInertiaInTheOrderOfItsReader) {
  Model m;
  m.model.bodies[0].inertia << 1, 0.1, 0.2, 0.1, 1.1, 0.3, 0.2, 0.3, 1.2;
  const std::string text = write_format("mjcf", m.model, {.prefix = "r"}).front().text;
  EXPECT_NE(text.find("fullinertia=\"1.0 1.1 1.2 0.1 0.2 0.3\""), std::string::npos) << text;
  EXPECT_NE(text.find("polycoef=\"0.25 -0.5 0 0 0\""), std::string::npos) << text;
}

TEST(Formats, LeaveOutSpheresOfUnknownLinksWithALineAndRefuseUnknownElements) {
  const Model m;
  SphereFile file{"x", {SphereGroup{.name = "elsewhere", .spheres = {{Point(0, 0, 0), 1}}, .masses = {}}}};
  EXPECT_EQ(place_in_links(m.robot, file, "x").size(), 1);
  EXPECT_TRUE(file.groups.empty());
  file.groups = {SphereGroup{
      .name = "base", .spheres = {{Point(0, 0, 0), 1}}, .masses = {}, .frame = apps::SphereFrame::mesh, .element = 3}};
  EXPECT_THROW(place_in_links(m.robot, file, "x"), InputError);
}

}  // namespace
}  // namespace orchard::robot
