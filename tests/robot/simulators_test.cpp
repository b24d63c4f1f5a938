// Files read by the simulators that they are for, where these are installed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "apps/program.h"
#include "orchard/geometry/atomic_file.h"
#include "programs.h"
#include "robot/bodies.h"
#include "robot/formats.h"
#include "robot/urdf_reader.h"
#include "support/effort.h"

namespace orchard::robot {
namespace {

using apps::SphereGroup;
using test::is_installed;
using test::Workplace;

// The desk arm with three spheres to a link, and one to its wrist.
struct Arm {
  Workplace here;
  Robot robot = read_urdf(ORCHARD_DATA_DIR "/desk-arm.urdf");
  SphereModel model{.robot = &robot, .groups = {}, .bodies = {}, .self = {}, .head = {"an arm"}};

  Arm() {
    for (const Link& link : robot.links) {
      if (link.collision.empty()) continue;
      SphereGroup group;
      group.name = link.name;
      for (int i = 0; i < (link.name == "wrist" ? 1 : 3); ++i)
        group.spheres.push_back({Point(0.1 * i, 0.01 * i * i, -0.03), 0.0712345 + 0.01 * i});
      model.groups.push_back(group);
      model.bodies.push_back(body_of(link, nullptr, group.spheres));
    }
  }
  std::string write(const char* format) const {
    std::string last;
    for (const FormatFile& file : write_format(format, model, {.prefix = "arm"})) {
      write_file(here / file.name, file.text);
      last = file.name;
    }
    return last;
  }
  int run(const std::string& command) const {
    const std::string folder = (here / ".").string();
    return std::system(("cd '" + folder + "' && " + command + " > log.txt 2>&1").c_str());
  }
  std::string log() const { return here.files(".").at("log.txt"); }
};

TEST(Simulators, MujocoHoldsEveryBallOfTheMjcf) {
#ifdef ORCHARD_MJCF_BALLS
  const Arm arm;
  const std::string file = arm.write("mjcf");
  ASSERT_EQ(arm.run(ORCHARD_MJCF_BALLS " " + file), 0) << arm.log();
  const apps::SphereFile read = apps::read_sphere_file(arm.here.add("balls.csv", "x,y,z,r,link\n" + arm.log()));
  ASSERT_EQ(read.groups.size(), arm.model.groups.size());
  for (const SphereGroup& group : arm.model.groups) {
    const SphereGroup& held = apps::group_named(read, "balls.csv", group.name);
    ASSERT_EQ(held.spheres.size(), group.spheres.size());
    for (std::size_t s = 0; s < group.spheres.size(); ++s) {
      EXPECT_EQ((held.spheres[s].center - group.spheres[s].center).norm(), 0);
      EXPECT_EQ(held.spheres[s].radius, group.spheres[s].radius);
    }
  }
#else
  GTEST_SKIP() << "MuJoCo is not installed";
#endif
}

TEST(ParticleSimulators, LiggghtsTakesTheTemplates) {
  if (test::more() == 1) GTEST_SKIP() << "one of the long tests";
  if (!is_installed("liggghts")) GTEST_SKIP() << "LIGGGHTS is not installed";
  const Arm arm;
  const std::string include = arm.write("liggghts");
  std::string templates;
  int count = 0;
  for (const SphereGroup& group : arm.model.groups) {
    if (group.spheres.size() == 1) continue;  // of another kind, which distributions of these do not take
    std::string name = group.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    templates += " " + name + " 0.1";
    ++count;
  }
  const std::string script =
      "units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\ncommunicate single vel yes\n"
      "region box block -5 5 -5 5 -5 5 units box\ncreate_box 1 box\nneighbor 0.1 bin\n"
      "fix m1 all property/global youngsModulus peratomtype 5e6\nfix m2 all property/global poissonsRatio peratomtype "
      "0.45\nfix m3 all property/global coefficientRestitution peratomtypepair 1 0.3\nfix m4 all property/global "
      "coefficientFriction peratomtypepair 1 0.5\npair_style gran model hertz tangential history\npair_coeff * *\n"
      "timestep 1e-5\ninclude " +
      include + "\nfix d all particledistribution/discrete 15485867 " + std::to_string(count) + templates;
  write_file(arm.here / "in.arm",
             script +
                 "\nfix i all insert/pack seed 32452867 distributiontemplate d maxattempt 100 insert_every once "
                 "overlapcheck yes all_in yes vel constant 0 0 0 region box particles_in_region 20\nfix s all "
                 "multisphere\nrun 1\n");
  EXPECT_EQ(arm.run("liggghts -in in.arm"), 0) << arm.log();
  EXPECT_EQ(arm.log().find("ERROR"), std::string::npos) << arm.log();
}

TEST(ParticleSimulators, LammpsTakesTheMolecules) {
  if (test::more() == 1) GTEST_SKIP() << "one of the long tests";
  if (!is_installed("lmp")) GTEST_SKIP() << "LAMMPS is not installed";
  const Arm arm;
  arm.write("lammps");
  std::string script = "units si\natom_style sphere\nregion box block -5 5 -5 5 -5 5\ncreate_box 1 box\n";
  int number = 0;
  for (const auto& [name, text] : arm.here.files(".")) {
    if (!name.ends_with(".mol")) continue;
    const std::string id = "m" + std::to_string(++number);
    script += "molecule " + id + " \"" + name + "\"\ncreate_atoms 0 single 0 0 " + std::to_string(number % 5) +
              " mol " + id + " 4711\n";
  }
  write_file(arm.here / "in.arm", script);
  EXPECT_EQ(arm.run("lmp -in in.arm"), 0) << arm.log();
  EXPECT_EQ(number, static_cast<int>(arm.model.groups.size()));
}

}  // namespace
}  // namespace orchard::robot
