#include <gtest/gtest.h>

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "improper_poses.h"
#include "orchard/runtime/orchard.h"
#include "orchard/runtime/tree_file.h"

namespace {

using namespace orchard::runtime::test;

struct Tree {
  explicit Tree(const Mesh& mesh) {
    const auto bytes = orchard::runtime::serialize(build_tree(mesh));
    tree = orchard_tree_load(bytes.data(), bytes.size(), nullptr);
  }
  ~Tree() { orchard_tree_close(tree); }
  orchard_tree* tree;
};

orchard_pose in_c(const orchard::runtime::Pose& pose) {
  orchard_pose result;
  std::memcpy(result.rotation, pose.rotation.data(), sizeof result.rotation);
  std::memcpy(result.translation, pose.translation.data(), sizeof result.translation);
  result.scale = pose.scale;
  return result;
}

TEST(CInterface, SaysThatNothingIsKnownOfImproperPoses) {
  const Tree cube(box({0, 0, 0}, {1, 1, 1}));
  orchard_pair* const pair = orchard_pair_new(cube.tree, cube.tree);
  const orchard_pose still = orchard_identity();
  const double p[3] = {8, 8, 8}, q[3] = {9, 8, 8};
  for (const auto& [name, pose] : improper_poses(Draw(1).pose(5))) {
    SCOPED_TRACE(name);
    const orchard_pose bad = in_c(pose);
    EXPECT_EQ(orchard_is_rigid(&bad), 0);
    const orchard_verdict verdict = orchard_collide(pair, &still, &bad, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT});
    EXPECT_EQ(verdict.answer, ORCHARD_MAYBE);
    EXPECT_TRUE(verdict.finished && verdict.refused);
    EXPECT_EQ(orchard_start(pair, &bad, &bad).answer, ORCHARD_MAYBE);
    EXPECT_EQ(orchard_refine(pair, {100, ORCHARD_NO_LIMIT}).answer, ORCHARD_MAYBE);
    const orchard_distance distance = orchard_measure(pair, &bad, &still, 0.01);
    EXPECT_EQ(distance.lower, 0);
    EXPECT_EQ(distance.upper, std::numeric_limits<double>::infinity());
    EXPECT_EQ(orchard_capsule_touches(cube.tree, &bad, p, q, 0.1), -1);
    EXPECT_EQ(orchard_contains(cube.tree, &bad, p), -1);
    double along = 1;
    EXPECT_EQ(orchard_cast_ray(cube.tree, &bad, p, q, 1, &along), -1);
    EXPECT_EQ(along, 0);
  }
  orchard_pose zeros;
  std::memset(&zeros, 0, sizeof zeros);
  EXPECT_EQ(orchard_collide(pair, &zeros, &zeros, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT}).answer, ORCHARD_MAYBE);
  EXPECT_EQ(orchard_is_rigid(&still), 1);
  EXPECT_FALSE(orchard_collide(pair, &still, &still, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT}).refused);
  EXPECT_EQ(orchard_capsule_touches(cube.tree, &still, p, q, 0.1), 0);
  EXPECT_EQ(orchard_capsule_touches(cube.tree, &still, p, q, 20), 1);
  EXPECT_EQ(orchard_contains(cube.tree, &still, p), 0);
  orchard_pair_free(pair);
}

TEST(CInterface, MakesFloatMatricesRigid) {
  const orchard::runtime::Pose truth = Draw(2).pose(1);
  float rotation[9], translation[3];
  for (std::size_t i = 0; i < 9; ++i) rotation[i] = static_cast<float>(truth.rotation[i]);
  for (std::size_t i = 0; i < 3; ++i) translation[i] = static_cast<float>(truth.translation[i]);
  orchard_pose pose = in_c(truth);
  for (double& x : pose.rotation) x = double{static_cast<float>(x)};
  EXPECT_EQ(orchard_is_rigid(&pose), 0);
  EXPECT_EQ(orchard_make_rigid(&pose), 1);
  EXPECT_EQ(orchard_is_rigid(&pose), 1);
  orchard_pose made = orchard_identity();
  EXPECT_EQ(orchard_pose_from_matrix(rotation, translation, 1, &made), 1);
  EXPECT_EQ(orchard_is_rigid(&made), 1);
  EXPECT_EQ(std::memcmp(made.rotation, pose.rotation, sizeof made.rotation), 0);
  const orchard_pose before = made;
  EXPECT_EQ(orchard_pose_from_matrix(rotation, translation, 0, &made), 0);
  rotation[4] += 0.5f;
  EXPECT_EQ(orchard_pose_from_matrix(rotation, translation, 1, &made), 0);
  EXPECT_EQ(std::memcmp(&made, &before, sizeof made), 0);
}

TEST(CInterface, ReadsAFileThatMayBeCutShortAfterwards) {
  const auto path = std::filesystem::temp_directory_path() / ("orchard_c_" + std::to_string(::getpid()) + ".orchard");
  const auto bytes = orchard::runtime::serialize(build_tree(torus(16, 8, 1, 0.3)));
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const char* error = nullptr;
  orchard_tree* const tree = orchard_tree_read(path.c_str(), &error);
  ASSERT_NE(tree, nullptr) << error;
  std::filesystem::resize_file(path, 0);
  orchard_pair* const pair = orchard_pair_new(tree, tree);
  const orchard_pose still = orchard_identity();
  EXPECT_EQ(orchard_collide(pair, &still, &still, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT}).answer, ORCHARD_YES);
  EXPECT_EQ(orchard_tree_read(path.c_str(), &error), nullptr);
  EXPECT_NE(std::strstr(error, "shorter"), nullptr) << error;
  std::filesystem::remove(path);
  EXPECT_EQ(orchard_tree_read(path.c_str(), &error), nullptr);
  EXPECT_NE(std::strstr(error, "opened"), nullptr) << error;
  orchard_pair_free(pair);
  orchard_tree_close(tree);
}

TEST(CInterface, LoadsNothingFromNothing) {
  const char* error = nullptr;
  EXPECT_EQ(orchard_tree_load(nullptr, 0, &error), nullptr);
  EXPECT_NE(error, nullptr);
}

}  // namespace
