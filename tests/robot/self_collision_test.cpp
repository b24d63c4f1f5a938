#include "robot/self_collision.h"

#include <gtest/gtest.h>

#include "apps/program.h"

namespace orchard::robot {
namespace {

using test::Workplace;

std::string box(const std::string& name, const std::string& size) {
  return "<link name='" + name + "'><collision><geometry><box size='" + size + "'/></geometry></collision></link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& xyz, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
         "'/><origin xyz='" + xyz + "'/>" + more + "</joint>\n";
}

// `far` and `near` hang on the same rail as `slider`, which moves along x from 0 to 4: over `near`, which is 1 wide and
// at x = 3; `inner` lies within `near`.
struct Rail {
  Workplace here;
  Robot robot = read_urdf(here.add(
      "rail.urdf", "<robot name='rail'>" + box("rail", "0.1 0.1 0.1") + box("slider", "1 1 1") + box("near", "1 1 1") +
                       box("far", "1 1 1") + box("inner", "0.2 0.2 0.2") + "<link name='mount'/>" +
                       box("hung", "0.1 0.1 0.1") +
                       joint("s", "prismatic", "rail", "slider", "0 0 5", "<limit lower='0' upper='4'/>") +
                       joint("n", "fixed", "rail", "near", "3 0 5") + joint("f", "fixed", "rail", "far", "20 0 5") +
                       joint("i", "fixed", "far", "mount", "0 0 0") + joint("m", "fixed", "mount", "inner", "-17 0 0") +
                       joint("h", "fixed", "inner", "hung", "0 0 9") + "</robot>"));
  std::vector<LinkShape> shapes = link_shapes(robot);
  std::vector<std::vector<Sphere>> spheres = [this] {
    std::vector<std::vector<Sphere>> all;
    for (const LinkShape& shape : shapes) all.push_back({shape.surface.bounding_ball()});
    return all;
  }();

  LinkPair pair(const SelfCollision& self, const char* a, const char* b) const {
    for (const LinkPair& one : self.pairs)
      if (robot.links[one.a].name == a && robot.links[one.b].name == b) return one;
    ADD_FAILURE() << a << " and " << b;
    return {};
  }
};

TEST(SelfCollision, CountsAsOftenAsClosedFormsSay) {
  const Rail rail;
  constexpr Index kStates = 2000;
  const SelfCollision self =
      sample_self_collision(rail.robot, rail.shapes, rail.spheres, {.states = kStates, .seed = 3});
  EXPECT_EQ(self.pairs.size(), 15);
  // Solids touch where 2 <= x <= 4, spheres of radius sqrt(3)/2 where |x - 3| <= sqrt(3): half and 2.73 of 4.
  const LinkPair near = rail.pair(self, "slider", "near");
  EXPECT_EQ(near.verdict, PairVerdict::sometimes);
  EXPECT_NEAR(near.touching, 0.5 * kStates, 90);
  EXPECT_NEAR(near.spheres_touching, (1 + std::sqrt(3)) / 4 * kStates, 90);
  EXPECT_EQ(rail.pair(self, "slider", "far").verdict, PairVerdict::never);
  EXPECT_EQ(rail.pair(self, "rail", "slider").verdict, PairVerdict::adjacent);
  EXPECT_EQ(rail.pair(self, "near", "inner").verdict, PairVerdict::always);   // no triangles meet
  EXPECT_EQ(rail.pair(self, "far", "inner").verdict, PairVerdict::adjacent);  // past a link without geometry
}

TEST(SelfCollision, SaysWhereSpheresAloneTouchInEveryState) {
  Rail rail;
  rail.spheres[1].front().radius = 9;
  const SelfCollision self = sample_self_collision(rail.robot, rail.shapes, rail.spheres, {.states = 500});
  const LinkPair near = rail.pair(self, "slider", "near");
  EXPECT_EQ(near.verdict, PairVerdict::spheres_always);
  EXPECT_TRUE(near.ignored());
  EXPECT_LT(near.touching, 500);
  EXPECT_EQ(near.spheres_touching, 500);
}

TEST(SelfCollision, DependsOnTheSeedAlone) {
  const Rail rail;
  const auto touching = [&](std::uint64_t seed) {
    return rail
        .pair(sample_self_collision(rail.robot, rail.shapes, rail.spheres, {.states = 700, .seed = seed}), "slider",
              "near")
        .touching;
  };
  EXPECT_EQ(touching(1), touching(1));
  EXPECT_NE(touching(1), touching(2));
}

}  // namespace
}  // namespace orchard::robot
