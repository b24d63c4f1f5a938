// Robots and sphere sets that others made, where they are there: not in the project itself.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/program.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/union_volume.h"
#include "robot/bodies.h"
#include "robot/formats.h"
#include "robot/link_shape.h"
#include "support/effort.h"

namespace orchard::robot {
namespace {

namespace fs = std::filesystem;
using apps::SphereFile;
using apps::SphereGroup;
using test::Workplace;

const fs::path kShared = ORCHARD_SHARED;

std::map<std::string, LinkShape> shapes_of(const fs::path& urdf, const ShapeOptions& options = {}) {
  const Robot robot = read_urdf(urdf);
  std::map<std::string, LinkShape> shapes;
  for (LinkShape& shape : link_shapes(robot, options)) shapes.emplace(robot.links[shape.link].name, std::move(shape));
  return shapes;
}

void expect_box(const LinkShape& shape, const Point& center, const Vector& size, const std::string& what) {
  const Box& box = shape.surface.bounding_box();
  EXPECT_TRUE(shape.surface.solid()) << what;
  EXPECT_EQ(shape.surface.mesh().triangles.size(), 12) << what;
  // Floats may be in between.
  EXPECT_LT((box.center() - center).norm(), 1e-7 * size.norm()) << what;
  EXPECT_LT((box.sizes() - size).norm(), 1e-7 * size.norm()) << what;
}

class Traps : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(traps)) GTEST_SKIP() << "no shared robots";
  }
  fs::path traps = kShared / "robots/traps";
  const Vector size{0.2, 0.1, 0.4};
};

TEST_F(Traps, FormatsAllGiveTheSameBox) {
  const auto shapes = shapes_of(traps / "formats.urdf");
  EXPECT_EQ(shapes.size(), 8);
  for (const auto& [name, shape] : shapes)
    expect_box(shape, name == "dae_node" ? Point(0.5, 0, 0) : Point(0, 0, 0), size, name);
}

TEST_F(Traps, DaeIsReadAsLoadersThatIgnoreUnitsAndAxesDoIfAsked) {
  const auto shapes = shapes_of(traps / "formats.urdf", {.dae = {.units = false, .up = false}});
  expect_box(shapes.at("dae_millimetres"), Point(0, 0, 0), 1000 * size, "millimetres");
  expect_box(shapes.at("dae_y_up"), Point(0, 0, 0), Vector(0.2, 0.4, 0.1), "y up");
  expect_box(shapes.at("dae"), Point(0, 0, 0), size, "plain");
}

TEST_F(Traps, SeveralElementsAreTheirUnion) {
  const auto shapes = shapes_of(traps / "several.urdf");
  EXPECT_EQ(shapes.at("a").surface.mesh().triangles.size(), 36);
  const std::vector<Sphere> ball{{Point(0, 0, 0), 0.1}};
  EXPECT_NEAR(union_volume(shapes.at("b").surface, ball, 400'000).solid, 0.012, 1e-5);
}

TEST_F(Traps, PrimitivesHaveTheirVolumes) {
  const auto shapes = shapes_of(traps / "primitives.urdf");
  EXPECT_FALSE(shapes.contains("empty"));
  const std::map<std::string, double> volumes{
      {"box", 0.008},
      {"cylinder", std::numbers::pi * 0.01 * 0.5},
      {"sphere", 4 * std::numbers::pi / 3 * std::pow(0.15, 3)},
      {"capsule", std::numbers::pi * 0.01 * 0.3 + 4 * std::numbers::pi / 3 * 0.001}};
  for (const auto& [name, volume] : volumes) {
    const LinkShape& shape = shapes.at(name);
    const double reach = shape.surface.bounding_radius();
    EXPECT_GE(shape.surface.report().volume, volume * (1 - 1e-12)) << name;
    EXPECT_LE(shape.surface.report().volume,
              volume * (1 + 1e-12) + shape.surface.report().area * shape.deviation * (1 + reach))
        << name;
  }
  EXPECT_EQ(shapes.at("mixed").original.triangles.size(), 12 + shapes.at("sphere").original.triangles.size());
  EXPECT_LT((shapes.at("sphere").surface.bounding_box().center() - Point(0, 0, 1)).norm(), 1e-12);
}

TEST_F(Traps, ScalesMayBeUnevenMirroredAndOneNumber) {
  for (const auto& [name, shape] : shapes_of(traps / "scale.urdf"))
    EXPECT_NEAR(shape.surface.report().volume, 0.008, 1e-9) << name;
}

TEST_F(Traps, NamesThatLeadNowhereAreNamedAndTheOthersFound) {
  try {
    read_urdf(traps / "names.urdf");
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* part : {"2 meshes", "BOX.STL", "not-there.stl", "there is box.stl", "tried"})
      EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
    for (const char* part : {"with space", "file://", "package://meshes"})
      EXPECT_EQ(message.find(part), std::string::npos) << part << " in " << message;
  }
}

TEST_F(Traps, PackagesAreFoundByTheirXml) {
  expect_box(shapes_of(traps / "trap_description/urdf/package.urdf").begin()->second, Point(0, 0, 0), size, "package");
}

// All spheres files, and the robot that each belongs to; empty: there is none.
std::vector<std::pair<fs::path, fs::path>> sphere_files() {
  return {{"vamp/panda_spherized.urdf", "panda/panda.urdf"},
          {"vamp/fetch_spherized.urdf", "fetch/fetch.urdf"},
          {"vamp/ur5_spherized.urdf", "ur5/ur5.urdf"},
          {"cricket/panda_spherized_1.urdf", "panda/panda.urdf"},
          {"cricket/fetch_spherized_1.urdf", "fetch/fetch.urdf"},
          {"cricket/ur5_spherized_1.urdf", "ur5/ur5.urdf"},
          {"foam/smaller_panda_spherized.urdf", "panda/panda.urdf"},
          {"foam/fetch_spherized_1.urdf", "fetch/fetch.urdf"},
          {"foam/fetch_spherized_6.urdf", "fetch/fetch.urdf"},
          {"foam/fetch_spherized_8.urdf", "fetch/fetch-full.urdf"},
          {"curobo/franka.yml", "panda_curobo/franka_panda.urdf"},
          {"curobo/ur10e.xrdf", ""},
          {"morphit/franka.yml", "panda_curobo/franka_panda.urdf"},
          {"morphit/panda", "panda_stl/panda.urdf"},
          {"morphit/abb_irb2400", "abb_irb2400/irb2400.urdf"},
          {"morphit/fetch", "fetch/fetch-morphit.urdf"},
          {"morphit/panda.spherical.urdf", "panda_stl/panda.urdf"},
          {"morphit/abb_irb2400.spherical.urdf", "abb_irb2400/irb2400.urdf"},
          {"morphit/fetch.spherical.urdf", "fetch/fetch-morphit.urdf"}};
}

// A robot of links without geometry, for a file that has none.
Robot bare_robot(const Workplace& here, const SphereFile& file) {
  std::string text = "<robot name='bare'>";
  for (const SphereGroup& group : file.groups) text += "<link name='" + group.name + "'/>";
  return read_urdf(here.add("bare.urdf", text + "</robot>"));
}

void expect_same(const SphereFile& read, const std::vector<SphereGroup>& written, double within,
                 const std::string& what) {
  ASSERT_EQ(read.groups.size(), written.size()) << what;
  for (std::size_t g = 0; g < written.size(); ++g) {
    EXPECT_EQ(read.groups[g].name, written[g].name) << what;
    ASSERT_EQ(read.groups[g].spheres.size(), written[g].spheres.size()) << what;
    for (std::size_t s = 0; s < written[g].spheres.size(); ++s) {
      const Sphere &a = read.groups[g].spheres[s], &b = written[g].spheres[s];
      ASSERT_LE((a.center - b.center).norm(), within) << what;
      ASSERT_NEAR(a.radius, b.radius, within) << what;
    }
  }
}

TEST(SharedSpheres, AreReadAndWrittenAgainAsTheSameBallsInEveryFormatOfRobots) {
  if (!fs::exists(kShared / "spheres")) GTEST_SKIP() << "no shared spheres";
  for (const auto& [spheres, urdf] : sphere_files()) {
    const Workplace here;
    SphereFile file = apps::read_sphere_file(kShared / "spheres" / spheres);
    const Robot robot = urdf.empty() ? bare_robot(here, file) : read_urdf(kShared / "robots" / urdf);
    for (const std::string& note : place_in_links(robot, file, spheres))
      EXPECT_TRUE(note.find("attached_object") != std::string::npos || note.find("torso_geo_link") != std::string::npos)
          << spheres << ": " << note;
    std::erase_if(file.groups, [](const SphereGroup& group) { return group.spheres.empty(); });
    ASSERT_FALSE(file.groups.empty()) << spheres;
    SphereModel model{.robot = &robot, .groups = file.groups, .bodies = {}, .self = {}, .head = {"again"}};
    for (const SphereGroup& group : model.groups)
      model.bodies.push_back(body_of(robot.links[*robot.find_link(group.name)], nullptr, group.spheres));
    for (const char* format :
         {"curobo", "curobo07", "xrdf", "urdf", "vamp", "srdf", "mjcf", "ballpark", "csv", "json"}) {
      std::string last;
      for (const FormatFile& out : write_format(format, model, {.prefix = "again"})) {
        write_file(here / out.name, out.text);
        last = (here / out.name).string();
      }
      SphereFile read = apps::read_sphere_file(last);
      std::erase_if(read.groups, [](const SphereGroup& group) { return group.spheres.empty(); });
      EXPECT_TRUE(place_in_links(robot, read, last).empty());
      expect_same(read, file.groups, format == std::string("srdf") ? 1e-13 : 0, spheres.string() + " as " + format);
    }
  }
}

TEST(SharedSpheres, OfMorphItsFilesAreThoseOfItsUrdf) {
  if (!fs::exists(kShared / "spheres")) GTEST_SKIP() << "no shared spheres";
  for (const auto& [name, urdf] : std::vector<std::pair<std::string, std::string>>{
           {"panda", "panda_stl/panda.urdf"}, {"abb_irb2400", "abb_irb2400/irb2400.urdf"}}) {
    const Robot robot = read_urdf(kShared / "robots" / urdf);
    SphereFile meshes = apps::read_sphere_file(kShared / "spheres/morphit" / name);
    SphereFile links = apps::read_sphere_file(kShared / "spheres/morphit" / (name + ".spherical.urdf"));
    place_in_links(robot, meshes, name);
    place_in_links(robot, links, name);
    expect_same(meshes, links.groups, 1e-6, name);
  }
}

nlohmann::json whole_of(const test::Finished& run) { return nlohmann::json::parse(run.out)["sets"][0]["whole"]; }

TEST(SharedRobots, AuditOfVampsPandaSaysHowMuchIsOpen) {
  if (!fs::exists(kShared / "spheres")) GTEST_SKIP() << "no shared spheres";
  const Workplace here;
  const test::Finished run = here.run({"audit", (kShared / "spheres/vamp/panda_spherized.urdf").string(),
                                       (kShared / "robots/panda/panda.urdf").string(), "--json"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NEAR(whole_of(run)["open_share_likely"].get<double>(), 0.49, 0.01);
  EXPECT_NEAR(whole_of(run)["largest_gap"].get<double>(), 0.082, 0.001);
  EXPECT_EQ(whole_of(run)["solid_links"], 10);  // one is open, and its volume is not defined
}

TEST(SharedRobots, SpheresAreClosedAndOfLessVolumeThanFoamsAtAsMany) {
  if (test::more() == 1) GTEST_SKIP() << "one of the long tests";
  if (!fs::exists(kShared / "spheres")) GTEST_SKIP() << "no shared spheres";
  const Workplace here;
  const std::string robot = (kShared / "robots/fetch/fetch-full.urdf").string();
  const auto rival = whole_of(
      here.run({"audit", (kShared / "spheres/foam/fetch_spherized_8.urdf").string(), robot, "--wrap", "--json"}));
  const test::Finished run =
      here.run({"robot", robot, "-o", (here / "out").string(), "--spheres", std::to_string(rival["spheres"].get<int>()),
                "--states", "0", "--no-views", "--no-picture", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto own = nlohmann::json::parse(run.out)["whole"];
  EXPECT_EQ(own["open_share"][1], 0);
  EXPECT_EQ(own["spheres"], rival["spheres"]);
  EXPECT_LT(own["union_over_solid"].get<double>(), rival["union_over_solid"].get<double>());
}

}  // namespace
}  // namespace orchard::robot
