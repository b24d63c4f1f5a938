#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// A unit cube around the origin, which a ball of radius .8666 covers.
struct Cube {
  Workplace here;
  std::string mesh = here.add("cube.obj", test::box(Point(-0.5, -0.5, -0.5), Point(0.5, 0.5, 0.5)));

  Finished run(const std::string& file, const std::string& text, std::vector<std::string> more = {"--json"}) const {
    std::vector<std::string> arguments{"audit", here.add(file, text), mesh};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return here.run(arguments);
  }
  json first_set(const std::string& file, const std::string& text, std::vector<std::string> more = {"--json"}) const {
    const Finished finished = run(file, text, std::move(more));
    EXPECT_TRUE(finished.exit_code == 0 || finished.exit_code == 3) << finished.err;
    return json::parse(finished.out)["sets"][0];
  }
};

TEST(Audit, ReadsTheSameSpheresInEveryFormat) {
  const Cube cube;
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.txt", "# two\n0 0 0 0.8666\n0,0,1; 0.25\n"},
      {"a.csv", "x,y,z,radius\n0,0,0,0.8666\n0,0,1,0.25\n"},
      {"a.json", "[[0,0,0,0.8666],[0,0,1,0.25]]"},
      {"b.json", R"([{"origin":[0,0,0],"radius":0.8666},{"center":[0,0,1],"radius":0.25}])"},
      {"c.json", R"([{"spheres":[[0,0,0,3]]},{"spheres":[[0,0,0,0.8666],[0,0,1,0.25]]}])"},
      {"d.json", R"({"centers":[[0,0,0],[0,0,1]],"radii":[0.8666,0.25]})"},
      {"e.json", R"({"link":{"centers":[[0,0,0],[0,0,1]],"radii":[0.8666,0.25]}})"},
      {"a.yml",
       "robot_cfg:\n  kinematics:\n    collision_spheres:\n      link:\n        - center: [0, 0, 0]\n          radius: "
       "0.8666\n        - center: [0, 0, 1]\n          radius: 0.25\n"},
      {"a.xrdf",
       "geometry:\n  g:\n    spheres:\n      link:\n        - {center: [0, 0, 0], radius: 0.8666}\n        - {center: "
       "[0, 0, 1], radius: 0.25}\n"},
      {"a.urdf",
       "<?xml version='1.0'?>\n<robot name=\"r\"><!-- <link name='x'> -->\n<link "
       "name=\"link\"><visual><geometry><sphere "
       "radius='9'/></geometry></visual>\n<collision><geometry><sphere radius=\"0.8666\"/></geometry></collision>"
       "<collision><origin rpy='0 0 1' xyz=' 0 0\t1'/><geometry><sphere radius='0.25'/></geometry></collision></link>"
       "<link name='empty'/></robot>\n"},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty "
       "float radius\nend_header\n0 0 0 0.8666\n0 0 1 0.25\n"},
      {"a.sph", "2 2\n0 0 0 9 0\n0 0 0 0.8666 0\n0 0 1 0.25 0\n"}};
  for (const auto& [file, text] : files) {
    const json set = cube.first_set(file, text);
    EXPECT_EQ(set["spheres"], 2) << file;
    EXPECT_TRUE(set["proven_closed"].get<bool>()) << file;
    EXPECT_NEAR(set["protrusion_max"][1].get<double>(), 0.75, 0.01) << file;
  }
}

TEST(Audit, EndsWithThreeWhereSurfaceIsOpenAndSaysHowMuch) {
  const Cube cube;
  const Finished run = cube.run("open.txt", "0 0 0.5 0.25\n", {});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.out.find("OPEN: 96.7 %"), std::string::npos) << run.out;
  EXPECT_EQ(cube.run("closed.txt", "0 0 0 0.87\n").exit_code, 0);
}

TEST(Audit, TakesRadiiOfZeroAndBelowForSwitchedOff) {
  const Cube cube;
  const json set = cube.first_set("off.txt", "0 0 0 0.87\n0 0 9 -0.01\n0 0 9 -100\n9 9 9 0\n");
  EXPECT_EQ(set["spheres"], 1);
  EXPECT_EQ(set["switched_off"], 3);
  EXPECT_NE(cube.run("off.txt", "0 0 0 0.87\n0 0 9 -0.01\n", {}).out.find("1 sphere is switched off"),
            std::string::npos);
  EXPECT_EQ(cube.run("all.txt", "0 0 0 -1\n").exit_code, 2);
}

TEST(Audit, JudgesSetsWithBuffersWithAndWithout) {
  const Cube cube;
  const std::string xrdf =
      "collision:\n  geometry: g\n  buffer_distance: {link: 0.3}\ngeometry:\n  g:\n    spheres:\n      link:\n        "
      "- {center: "
      "[0, 0, 0], radius: 0.6}\n";
  const Finished run = cube.run("b.xrdf", xrdf);
  const json sets = json::parse(run.out)["sets"];
  ASSERT_EQ(sets.size(), 2);
  EXPECT_FALSE(sets[0]["closed"].get<bool>());
  EXPECT_TRUE(sets[1]["closed"].get<bool>());
  EXPECT_EQ(sets[1]["buffer"], 0.3);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(json::parse(cube.run("b.xrdf", xrdf, {"--json", "--buffer", "0"}).out)["sets"].size(), 1);
}

TEST(Audit, SuggestsTheUnitOrTheFrameOfASetThatDoesNotTouch) {
  const Cube cube;
  std::string in_kilometres, elsewhere;
  for (const char* x : {"-0.0005", "0.0005"}) in_kilometres += std::string(x) + " 0.0004 0 0.0003\n";
  const Finished unit = cube.run("unit.txt", in_kilometres, {});
  EXPECT_EQ(unit.exit_code, 3);
  EXPECT_NE(unit.out.find("multiplied by 1000"), std::string::npos) << unit.out;
  const Finished frame = cube.run("frame.txt", "9.5 0 0 0.5\n10.5 0 0 0.5\n", {});
  EXPECT_NE(frame.out.find("no sphere touches"), std::string::npos) << frame.out;
  EXPECT_NE(frame.out.find("moved by (-10, 0, 0)"), std::string::npos) << frame.out;
}

TEST(Audit, NamesFileAndLineOfWhatItCannotRead) {
  const Cube cube;
  const std::vector<std::array<std::string, 3>> files{
      {"nan.txt", "0 0 0 1\n0 0 nan 1\n", "nan.txt, line 2"},
      {"few.txt", "0 0 0 1\n0 0 0\n", "few.txt, line 2"},
      {"bad.json", "[\n[0,0,0,1],\n[0,0", "bad.json, line 3"},
      {"nan.yml", "collision_spheres:\n  l:\n    - center: [0, 0, .nan]\n      radius: 1\n", "nan.yml, line 3"},
      {"bad.yml", "collision_spheres:\n  l:\n    - center: [0, 0]\n", "bad.yml, line 3"},
      {"bad.urdf", "<robot>\n<link name='a'>\n<collision></link></robot>", "bad.urdf, line 3"},
      {"number.urdf",
       "<robot><link name='a'><collision>\n<origin xyz='0 0'/>\n<geometry><sphere radius='1'/></geometry></collision>"
       "</link></robot>",
       "number.urdf, line 2"},
      {"infinite.urdf",
       "<robot><link><collision><geometry>\n<sphere radius='inf'/></geometry></collision></link></robot>",
       "infinite.urdf, line 2"},
      {"other.urdf", "<mujoco/>", "other.urdf, line 1"},
      {"endless.urdf", "<robot><link name='a\n", "endless.urdf, line 1"},
      {"masses.json", R"({"centers":[[0,0,0]],"radii":[1],"masses":[1,2]})", "masses.json"},
      {"mass.json", R"({"centers":[[0,0,0]],"radii":[1],"masses":[-1]})", "mass.json"},
      {"empty.txt", "# nothing\n", "empty.txt"},
      {"what.dat", "0 0 0 1\n", "what.dat"}};
  for (const auto& [file, text, where] : files) {
    const Finished run = cube.run(file, text);
    EXPECT_EQ(run.exit_code, 2) << file;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(where), std::string::npos) << run.err;
  }
}

TEST(Audit, AsksForTheLinkWhereThereAreSeveral) {
  const Cube cube;
  const std::string two = R"({"arm":{"centers":[[0,0,0]],"radii":[1]},"hand":{"centers":[[0,0,0]],"radii":[0.1]}})";
  const Finished run = cube.run("two.json", two);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("arm, hand"), std::string::npos) << run.err;
  EXPECT_EQ(cube.run("two.json", two, {"--link", "arm"}).exit_code, 0);
}

TEST(Audit, JudgesMassesWhereAFileHasThem) {
  const Cube cube;
  // Two masses of 1 and 3 at distance 4: the centre is 1 from the heavy one, and the inertia across is 1 * 9 + 3 * 1
  // and the balls' own.
  const json set =
      cube.first_set("m.json", R"({"centers":[[-3,0,0],[1,0,0],[0,0,0]],"radii":[0.5,0.5,0],"masses":[1,3,5]})");
  const json& body = set["particles"];
  EXPECT_EQ(body["mass"], 4);
  EXPECT_NEAR(body["mass_center"][0].get<double>(), 0, 1e-12);
  EXPECT_NEAR(body["inertia"][1][1].get<double>(), 12 + 0.4 * 4 * 0.25, 1e-12);
  EXPECT_NEAR(body["inertia"][0][0].get<double>(), 0.4 * 4 * 0.25, 1e-12);
  EXPECT_EQ(body["largest_overlap"], 0);
  EXPECT_FALSE(cube.first_set("no.txt", "0 0 0 1\n").contains("particles"));
}

}  // namespace
}  // namespace orchard
