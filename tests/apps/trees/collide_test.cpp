#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Workplace;

// Trees of a large ball, a small one, and two small ones that are one mesh, eight apart along x.
struct Balls {
  const Workplace here;

  Balls() {
    const TriangleMesh small = test::icosphere(1);
    build("large", test::icosphere(2, 3)), build("small", small);
    build("two", test::joined({small, test::transformed(small, 1, {8, 0, 0})}));
  }
  void build(const std::string& name, const TriangleMesh& mesh) const {
    EXPECT_EQ(here.run(test::quick_build(here.add(name + ".obj", mesh), (here / name).string())).exit_code, 0);
  }
  std::string tree(const std::string& name) const { return (here / name).string() + "/" + name + ".orchard"; }
  std::string said(const std::string& a, const std::string& b, const std::string& pose) const {
    return here.run({"collide", tree(a), tree(b), "--pose", pose}).out;
  }
  json inside(const std::string& a, const std::string& b, const std::string& pose) const {
    return json::parse(here.run({"collide", tree(a), tree(b), "--pose", pose, "--json"}).out)["inside"];
  }
};

TEST(Collide, SaysThatABodyLiesInsideTheOther) {
  const Balls balls;
  EXPECT_NE(balls.said("large", "small", "1 0 0 1 0 0 0").find("b lies inside a"), std::string::npos);
  EXPECT_NE(balls.said("small", "large", "1 0 0 1 0 0 0").find("a lies inside b"), std::string::npos);
  const json inside = balls.inside("large", "small", "1 0.5 0 1 0 0 0");
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_EQ(inside[0], (json{{"inner", "b"}, {"outer", "a"}, {"pieces", 1}, {"of", 1}}));
}

TEST(Collide, CountsThePiecesOfABodyThatLieInsideTheOther) {
  const Balls balls;
  EXPECT_NE(balls.said("large", "two", "0 0 0 1 0 0 0").find("1 of the 2 pieces of b lies inside a"),
            std::string::npos);
  EXPECT_EQ(balls.inside("large", "two", "-8 0 0 1 0 0 0")[0]["pieces"], 1);
  EXPECT_EQ(balls.inside("large", "two", "-4 0 0 1 0 0 0").size(), 0u);
}

TEST(Collide, SaysNothingOfInsideWhereBodiesAreApartOrTouch) {
  const Balls balls;
  for (const char* pose : {"5 0 0 1 0 0 0", "3 0 0 1 0 0 0"}) {
    EXPECT_EQ(balls.said("large", "small", pose).find("inside"), std::string::npos) << pose;
    EXPECT_EQ(balls.inside("large", "small", pose).size(), 0u) << pose;
  }
}

}  // namespace
}  // namespace orchard
