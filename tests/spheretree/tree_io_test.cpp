#include "orchard/spheretree/tree_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/octree.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

class SphFile : public testing::Test {
 protected:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      (std::string("orchard_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".sph");
  ~SphFile() override { std::filesystem::remove(path_); }

  std::string error_of(const std::string& text) {
    write_file(path_, text);
    try {
      read_sph(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(SphFile, RoundTripsEveryBitOfTheSpheres) {
  const Surface surface(transformed(u_shape(0.3), 1.0 / 3, Vector(0.1, 1e5, -7)));
  const SphereTree tree = octree(surface, {.depth = 3});
  write_file(path_, to_sph(tree));
  EXPECT_TRUE(same_tree(read_sph(path_), tree));
}

TEST_F(SphFile, StartsWithLevelsAndBranchingAndHoldsTheCompleteTree) {
  const Surface surface(l_shape());
  const std::string text = to_sph(octree(surface, {.depth = 3}));
  EXPECT_EQ(text.substr(0, 4), "4 8\n");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 1 + 8 + 64 + 512);
}

TEST_F(SphFile, TakesNodesThatAreMissingAtTheEndAsUnused) {
  write_file(path_, "2 8\n0 0 0 1 1\n0.5 0 0 0.5 1\r\n\n");
  const SphereTree tree = read_sph(path_);
  EXPECT_EQ(tree.nodes.size(), 2u);
  EXPECT_NO_THROW(validate(tree));
}

TEST_F(SphFile, TakesNumbersAsOtherProgramsWriteThem) {
  write_file(path_, "# of some program\n2 8\n+0.5 1e-999 -0 +1 1\n\t.5 0. 5E-1 .25\n");
  const SphereTree tree = read_sph(path_);
  ASSERT_EQ(tree.nodes.size(), 2u);
  EXPECT_EQ(tree.nodes[0].sphere.center, Point(0.5, 0, 0));
  EXPECT_EQ(tree.nodes[1].sphere.center, Point(0.5, 0, 0.5));
  EXPECT_EQ(tree.nodes[1].sphere.radius, 0.25);
}

TEST_F(SphFile, NamesFileAndLineOfWhatItCannotRead) {
  const struct {
    const char* text;
    const char* fault;
  } cases[] = {
      {"", "is empty; a .sph file starts with \"levels branching\""},
      {"two eight\n", ", line 1: expected \"levels branching\", two whole numbers, at \"two eight\""},
      {"4\n", ", line 1: expected \"levels branching\", two whole numbers, at the end of the line"},
      {"2.5 8\n", ", line 1: \"levels branching\" must be two whole numbers"},
      {"0 8\n", ", line 1: \"levels branching\" must be two whole numbers, 1 to 64 and 1 to 4096"},
      {"3 8\n0 0 0 1 1\n1 2 three 4 5\n", ", line 3: expected \"x y z radius\", four finite numbers, at \"three"},
      {"3 8\n\n0 0 0\n", ", line 3: expected \"x y z radius\""},
      {"3 8\n0 0 0 nan 1\n", ", line 2: the number is not finite"},
      {"3 8\n0 0 0 1e999 1\n", ", line 2: expected \"x y z radius\""},
      {"3 8\n0 0 0 -1 1\n", ", line 2: the first node, the root, must be in use"},
      {"60 4000\n0 0 0 1 1\n", ", line 1: the file promises more than"}};
  for (const auto& [text, fault] : cases) {
    const std::string error = error_of(text);
    EXPECT_EQ(error.find(path_.string()), 0u) << error;
    EXPECT_NE(error.find(fault), std::string::npos) << error;
  }
  EXPECT_THROW(read_sph("/nonexistent/tree.sph"), InputError);
  EXPECT_THROW(read_sph(std::filesystem::temp_directory_path()), InputError);
}

TEST_F(SphFile, RefusesToWriteATreeThatTheFormatWouldBlowUp) {
  SphereTree tree;
  tree.branching = 64;
  for (Index level = 0; level < 8; ++level)
    tree.nodes.push_back({.sphere = {Point::Zero(), 1},
                          .parent = level == 0 ? kNone : level - 1,
                          .first_child = level < 7 ? level + 1 : kNone,
                          .child_count = level < 7 ? 1u : 0u,
                          .level = level});
  validate(tree);
  EXPECT_THROW(to_sph(tree), InputError);
}

}  // namespace
}  // namespace orchard
