#include "robot/urdf_reader.h"

#include <gtest/gtest.h>

#include <fstream>

#include "apps/program.h"
#include "orchard/geometry/error.h"
#include "programs.h"
#include "robot/mesh_search.h"
#include "support/shapes.h"

namespace orchard::robot {
namespace {

using test::has;
using test::Workplace;

std::string message_of(const std::string& file, const UrdfOptions& options = {}) {
  try {
    read_urdf(file, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(UrdfReader, NamesFileAndLineOfEveryFault) {
  const Workplace here;
  const std::vector<std::array<std::string, 3>> cases{
      {"<robot name='r'>\n<link name='a'>\n</robot>", ", line ", "well-formed"},
      {"<mujoco/>", "line 1", "<mujoco>"},
      {"<robot name='r'>\n</robot>", "r.urdf", "no link"},
      {"<robot>\n<link name='a'/>\n<link name='a'/>\n</robot>", "line 3", "already a link a"},
      {"<robot>\n<link/>\n</robot>", "line 2", "no name"},
      {"<robot>\n<link name='a'/>\n<joint name='j' type='fixed'>\n<parent link='a'/>\n<child "
       "link='b'/></joint></robot>",
       "line 5", "no link b"},
      {"<robot>\n<link name='a'/>\n<joint name='j' type='odd'><parent link='a'/><child link='a'/></joint></robot>",
       "line 3", "odd"},
      {"<robot><link name='a'><collision>\n<origin xyz='0 0'/><geometry><sphere radius='1'/></geometry></collision>"
       "</link></robot>",
       "line 2", "3 numbers"},
      {"<robot><link name='a'><collision><geometry>\n<sphere radius='-1'/></geometry></collision></link></robot>",
       "line 2", "above 0"},
      {"<robot><link name='a'><collision><geometry>\n<box size='1 nan 1'/></geometry></collision></link></robot>",
       "line 2", "finite"},
      {"<robot><link name='a'>\n<collision/></link></robot>", "line 2", "<geometry>"},
      {"<robot xmlns:xacro='x'><link name='a'/>\n<xacro:include filename='b'/></robot>", "r.urdf", "xacro r.urdf"},
  };
  for (const auto& [text, place, fault] : cases) {
    const std::string message = message_of(here.add("r.urdf", text));
    EXPECT_TRUE(has(message, place) && (has(message, fault) || fault == "xacro r.urdf")) << message << "\n" << text;
  }
}

TEST(UrdfReader, RefusesLoopsAndSecondParents) {
  const Workplace here;
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name='" + name + "' type='fixed'><parent link='" + parent + "'/><child link='" + child +
           "'/></joint>\n";
  };
  const std::string links = "<robot>\n<link name='a'/><link name='b'/><link name='c'/>\n";
  EXPECT_TRUE(
      has(message_of(here.add("a.urdf", links + joint("i", "a", "b") + joint("j", "b", "a") + "</robot>")), "loop"));
  EXPECT_TRUE(has(message_of(here.add("b.urdf", links + joint("i", "a", "c") + joint("j", "b", "c") + "</robot>")),
                  "two parents"));
  EXPECT_TRUE(has(message_of(here.add("c.urdf", links + joint("i", "a", "a") + "</robot>")), "loop"));
}

TEST(UrdfReader, NamesAllMissingMeshesAtOnceAndWhatWasTried) {
  const Workplace here;
  here.add("box.obj", test::box(Point(0, 0, 0), Point(1, 1, 1)));
  const auto mesh = [](const std::string& link, const std::string& file) {
    return "<link name='" + link + "'><collision><geometry><mesh filename='" + file +
           "'/></geometry></collision></link>\n";
  };
  const std::string message =
      message_of(here.add("r.urdf", "<robot>\n" + mesh("a", "BOX.OBJ") + mesh("b", "box.obj") +
                                        mesh("c", "package://p/c.stl") + mesh("d", "file://gone.dae") + "</robot>"));
  EXPECT_TRUE(has(message, "3 meshes")) << message;
  for (const char* part : {"line 2: BOX.OBJ", "there is box.obj", "line 4: package://p/c.stl",
                           "line 5: file://gone.dae", "--package-path"})
    EXPECT_TRUE(has(message, part)) << part << " in " << message;
  EXPECT_FALSE(has(message, "line 3")) << message;
}

TEST(UrdfReader, SaysWhatItLeavesOut) {
  const Workplace here;
  const Robot robot = read_urdf(here.add("r.urdf",
                                         "<robot>\n<link name='a'><collision><geometry>\n<torus/>"
                                         "</geometry></collision></link>\n<wheel/>\n<wheel/>\n<link name='b'>"
                                         "<visual><geometry><sphere radius='1'/></geometry></visual></link>\n"
                                         "<joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>"
                                         "</robot>"));
  const auto noted = [&](const std::string& a, const std::string& b) {
    return std::any_of(robot.notes.begin(), robot.notes.end(),
                       [&](const std::string& note) { return has(note, a) && has(note, b); });
  };
  EXPECT_TRUE(noted("line 3", "<torus>"));
  EXPECT_TRUE(noted("line 4, and 1 more", "<wheel>"));
  EXPECT_TRUE(noted("link b", "visual geometry alone"));
  EXPECT_TRUE(noted("joint j", "no limits"));
  EXPECT_TRUE(robot.links[0].collision.empty());
}

TEST(UrdfReader, FindsMeshesOfPackagesAboveTheUrdfAndInGivenFolders) {
  const Workplace here;
  namespace fs = std::filesystem;
  fs::create_directories(here / "own/urdf");
  fs::create_directories(here / "own/meshes");
  fs::create_directories(here / "elsewhere/other/meshes");
  here.add("own/package.xml", "<package><name>called_otherwise</name></package>");
  here.add("own/meshes/a b.stl", "x");
  here.add("elsewhere/other/meshes/c.stl", "x");
  const fs::path urdf = here / "own/urdf/r.urdf";
  EXPECT_EQ(find_mesh("package://called_otherwise/meshes/a b.stl", urdf, {}).file.filename(), "a b.stl");
  EXPECT_EQ(find_mesh("package://called_otherwise/meshes/a%20b.stl", urdf, {}).file, fs::path());
  EXPECT_EQ(find_mesh("package://own/meshes/a b.stl", urdf, {}).file.filename(), "a b.stl");
  EXPECT_EQ(find_mesh("../meshes/a%20b.stl", urdf, {}).file.filename(), "a b.stl");
  EXPECT_TRUE(find_mesh("package://other/meshes/c.stl", urdf, {}).file.empty());
  EXPECT_FALSE(find_mesh("package://other/meshes/c.stl", urdf, {}).tried.empty());
  EXPECT_EQ(find_mesh("package://other/meshes/c.stl", urdf, {here / "elsewhere"}).file.filename(), "c.stl");
  EXPECT_EQ(find_mesh("package://other/meshes/c.stl", urdf, {here / "elsewhere/other"}).file.filename(), "c.stl");
}

}  // namespace
}  // namespace orchard::robot
