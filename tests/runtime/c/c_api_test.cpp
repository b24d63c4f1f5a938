// The C interface, function after function: hence more than 300 lines.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
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
  orchard_tree* const tree = orchard_tree_read(path.string().c_str(), &error);
  ASSERT_NE(tree, nullptr) << error;
  std::filesystem::resize_file(path, 0);
  orchard_pair* const pair = orchard_pair_new(tree, tree);
  const orchard_pose still = orchard_identity();
  EXPECT_EQ(orchard_collide(pair, &still, &still, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT}).answer, ORCHARD_YES);
  EXPECT_EQ(orchard_tree_read(path.string().c_str(), &error), nullptr);
  EXPECT_NE(std::strstr(error, "shorter"), nullptr) << error;
  std::filesystem::remove(path);
  EXPECT_EQ(orchard_tree_read(path.string().c_str(), &error), nullptr);
  EXPECT_NE(std::strstr(error, "opened"), nullptr) << error;
  orchard_pair_free(pair);
  orchard_tree_close(tree);
}

TEST(CInterface, LoadsNothingFromNothing) {
  const char* error = nullptr;
  EXPECT_EQ(orchard_tree_load(nullptr, 0, &error), nullptr);
  EXPECT_NE(error, nullptr);
}

TEST(CInterface, TakesQuaternionsAsTheOtherHeadersDo) {
  const double wxyz[4] = {0.3, -2, 0.5, 1}, translation[3] = {1, 2, 3};
  orchard_pose pose;
  ASSERT_EQ(orchard_pose_from_quaternion(wxyz, translation, &pose), 1);
  const auto expected = orchard::runtime::pose_from_quaternion({0.3, -2, 0.5, 1}, {1, 2, 3});
  ASSERT_TRUE(expected);
  const orchard_pose other = in_c(*expected);
  EXPECT_EQ(std::memcmp(&pose, &other, sizeof pose), 0);
  EXPECT_EQ(orchard_is_rigid(&pose), 1);
  const double zero[4] = {0, 0, 0, 0}, infinite[4] = {1, HUGE_VAL, 0, 0}, beyond[3] = {NAN, 0, 0};
  for (const auto& [q, t] : {std::pair{zero, translation}, {infinite, translation}, {wxyz, beyond}}) {
    EXPECT_EQ(orchard_pose_from_quaternion(q, t, &pose), 0);
    EXPECT_EQ(std::memcmp(&pose, &other, sizeof pose), 0) << "it was changed";
  }
}

TEST(CInterface, SaysItsVersion) {
  EXPECT_STREQ(orchard_version(), ORCHARD_VERSION_STRING);
  const std::string text = std::to_string(ORCHARD_VERSION_MAJOR) + "." + std::to_string(ORCHARD_VERSION_MINOR) + "." +
                           std::to_string(ORCHARD_VERSION_PATCH);
  EXPECT_EQ(text, ORCHARD_VERSION_STRING);
  static_assert(ORCHARD_VERSION_NUMBER >= ORCHARD_MAKE_VERSION(0, 1, 0));
  static_assert(ORCHARD_MAKE_VERSION(0, 2, 0) > ORCHARD_MAKE_VERSION(0, 1, 999));
}

constexpr orchard_budget kNoBudget = {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT};

struct Work {
  Work() : workspace(orchard_workspace_new()) {}
  ~Work() { orchard_workspace_free(workspace); }
  orchard_workspace* workspace;
};

orchard_pose at(double x, double y, double z) { return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, y, z}, 1}; }

TEST(CInterface, HasContactsClearanceAndTimesOfImpact) {
  const Tree cube(box({-1, -1, -1}, {1, 1, 1}));
  const Work work;
  const orchard_pose still = orchard_identity(), near = at(1.99, 0.2, 0.1), far = at(6, 0, 0);
  const orchard_manifold m = orchard_contacts(work.workspace, cube.tree, &still, cube.tree, &near, 0);
  EXPECT_EQ(m.answer, ORCHARD_YES);
  EXPECT_EQ(m.count, 4u);
  EXPECT_EQ(m.complete, 1);
  EXPECT_NEAR(m.normal[0], 1, 1e-9);
  EXPECT_NEAR(m.depth, 0.01, 1e-9);
  EXPECT_LT(m.points[0].triangle_a, 12u);
  EXPECT_EQ(orchard_contacts(work.workspace, cube.tree, &still, cube.tree, &far, 0).answer, ORCHARD_NO);
  EXPECT_EQ(orchard_closer_than(work.workspace, cube.tree, &still, cube.tree, &far, 3.9, nullptr), 0);
  EXPECT_EQ(orchard_closer_than(work.workspace, cube.tree, &still, cube.tree, &far, 4.1, nullptr), 1);
  EXPECT_EQ(orchard_closer_than(work.workspace, cube.tree, &still, cube.tree, &far, std::nan(""), nullptr), -1);

  orchard_travel rest{}, moving{};
  rest.start = still, moving.start = far;
  moving.velocity[0] = -8;
  const orchard_impact hit =
      orchard_time_of_impact(work.workspace, cube.tree, &rest, cube.tree, &moving, 0, 1, 1e-6, 0, kNoBudget);
  EXPECT_EQ(hit.answer, ORCHARD_YES);
  EXPECT_TRUE(hit.finished && !hit.refused);
  EXPECT_NEAR(hit.t0, 0.5, 1e-6);
  // The same motion by a function, and one that fails.
  orchard_travel by_function = moving;
  by_function.velocity[0] = 0;
  by_function.speed = 8;
  by_function.pose_at = [](const void* context, double time, orchard_pose* pose) {
    *pose = *static_cast<const orchard_pose*>(context);
    pose->translation[0] -= 8 * time;
    return 1;
  };
  by_function.context = &far;
  EXPECT_NEAR(
      orchard_time_of_impact(work.workspace, cube.tree, &rest, cube.tree, &by_function, 0, 1, 1e-6, 0, kNoBudget).t0,
      0.5, 1e-6);
  by_function.pose_at = [](const void*, double, orchard_pose*) { return 0; };
  EXPECT_TRUE(
      orchard_time_of_impact(work.workspace, cube.tree, &rest, cube.tree, &by_function, 0, 1, 1e-6, 0, kNoBudget)
          .refused);
  const double middle[3] = {0, 0, 0};
  const orchard_travel between = orchard_travel_between(&far, &still, middle);
  EXPECT_NEAR(between.velocity[0], -6, 1e-12);
}

TEST(CInterface, HasShapesAndTheirTrees) {
  const Tree cube(box({-1, -1, -1}, {1, 1, 1}));
  const Work work;
  const orchard_pose still = orchard_identity(), aside = at(1.4, 0, 0), away = at(3, 0, 0);
  const double half[3] = {0.5, 0.5, 0.5}, up[3] = {0, 0, 2}, origin[3] = {0, 0, 0}, end[3] = {0, 0, 1};
  EXPECT_EQ(orchard_box_touches(cube.tree, &still, half, &aside), 1);
  EXPECT_EQ(orchard_box_touches(cube.tree, &still, half, &away), 0);
  EXPECT_EQ(orchard_box_touches(cube.tree, &still, origin, &away), -1);
  EXPECT_NEAR(orchard_plane_distance(cube.tree, &still, up, -1), -0.5, 1e-12);
  const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const uint32_t facets[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_EQ(orchard_hull_touches(cube.tree, &still, corners[0], 4, facets[0], 4, &aside), 0);
  const orchard_pose close = at(0.9, 0, 0);
  EXPECT_EQ(orchard_hull_touches(cube.tree, &still, corners[0], 4, facets[0], 4, &close), 1);
  orchard_tree* const trees[] = {orchard_point_tree(origin), orchard_segment_tree(origin, end), orchard_box_tree(half),
                                 orchard_hull_tree(corners[0], 4)};
  for (orchard_tree* tree : trees) {
    ASSERT_NE(tree, nullptr);
    EXPECT_EQ(orchard_closer_than(work.workspace, cube.tree, &still, tree, &away, 2.1, nullptr), 1);
    EXPECT_EQ(orchard_closer_than(work.workspace, cube.tree, &still, tree, &away, 1.4, nullptr), 0);
    orchard_tree_close(tree);
  }
  EXPECT_EQ(orchard_hull_tree(corners[0], 3), nullptr);
  double distance = 0, point[3];
  uint32_t triangle = 0;
  EXPECT_EQ(orchard_nearest_point(cube.tree, &still, away.translation, 5, &distance, point, &triangle), 1);
  EXPECT_EQ(distance, 2);
  EXPECT_EQ(point[0], 1);
  EXPECT_EQ(orchard_nearest_point(cube.tree, &still, away.translation, 1, nullptr, nullptr, nullptr), 0);
}

TEST(CInterface, AsksManyThingsAtOnce) {
  const Tree cube(box({-1, -1, -1}, {1, 1, 1}));
  const double origins[3][3] = {{5, 0, 0}, {5, 3, 0}, {0, 0, 9}},
               directions[3][3] = {{-1, 0, 0}, {-1, 0, 0}, {0, 0, -2}};
  int hit[3];
  double along[3];
  const orchard_pose still = orchard_identity();
  orchard_cast_rays(cube.tree, &still, origins[0], directions[0], 100, 3, hit, along);
  EXPECT_EQ(hit[0], 1);
  EXPECT_EQ(along[0], 4);
  EXPECT_EQ(hit[1], 0);
  EXPECT_EQ(hit[2], 1);
  EXPECT_EQ(along[2], 4);
  ASSERT_EQ(orchard_index_rays(cube.tree), 1);
  for (int& h : hit) h = 7;
  orchard_cast_rays(cube.tree, &still, origins[0], directions[0], 100, 3, hit, along);
  EXPECT_EQ(hit[0], 1);
  EXPECT_EQ(along[0], 4);
  EXPECT_EQ(hit[1], 0);
  EXPECT_EQ(hit[2], 1);
  EXPECT_EQ(orchard_cast_ray(cube.tree, &still, origins[2], directions[2], 100, along), 1);
  EXPECT_EQ(along[0], 4);

  std::vector<orchard_pose> a(100, still), b;
  const std::vector<const orchard_tree*> trees(100, cube.tree);
  for (int i = 0; i < 100; ++i) b.push_back(at(0.04 * i, 0.3, 0));
  const Work first, second;
  orchard_workspace* const workspaces[] = {first.workspace, second.workspace};
  std::vector<orchard_verdict> verdicts(100);
  const orchard_executor backward = {[](void*, size_t count, void (*job)(void*, size_t), void* data) {
                                       while (count-- > 0) job(data, count);
                                     },
                                     nullptr, 2};
  const orchard_batch batch = {trees.data(), a.data(), trees.data(), b.data(), 100, workspaces, 2, &backward};
  orchard_collide_all(&batch, verdicts.data());
  orchard_pair* const pair = orchard_pair_new(cube.tree, cube.tree);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(verdicts[i].answer, orchard_collide(pair, &a[i], &b[i], kNoBudget).answer) << i;
    EXPECT_EQ(verdicts[i].finished, 1);
    EXPECT_EQ(orchard_collide_again(pair, &a[i], &b[i]).answer, verdicts[i].answer) << i;
  }
  EXPECT_EQ(orchard_start(pair, &a[60], &b[20]).answer, ORCHARD_MAYBE);
  orchard_verdict stepped{};
  for (int i = 0; i < 10 && !stepped.finished; ++i) stepped = orchard_refine(pair, kNoBudget);
  EXPECT_EQ(stepped.answer, ORCHARD_YES);
  orchard_pair_free(pair);
}

TEST(CInterface, MeasuresManyPairsAsItMeasuresEach) {
  const Tree cube(box({-1, -1, -1}, {1, 1, 1})), ball(uv_sphere(12, 8, 1));
  const std::vector<const orchard_tree*> first(60, cube.tree), second(60, ball.tree);
  std::vector<orchard_pose> a, b;
  Draw draw(11);
  for (std::size_t i = 0; i < 60; ++i) a.push_back(in_c(draw.pose(1))), b.push_back(in_c(draw.pose(4)));
  b[7].scale = 0;  // of which nothing is known
  orchard_workspace* workspaces[] = {orchard_workspace_new(), orchard_workspace_new(), orchard_workspace_new()};
  const orchard_executor backward = {[](void*, size_t count, void (*job)(void*, size_t), void* data) {
                                       while (count-- > 0) job(data, count);
                                     },
                                     nullptr, 3};
  std::vector<orchard_distance> distances(60);
  std::vector<int> closer(60);
  orchard_batch batch = {first.data(), a.data(), second.data(), b.data(), 60, workspaces, 3, &backward};
  orchard_measure_all(&batch, 0.01, distances.data());
  orchard_closer_than_all(&batch, 1, closer.data());
  std::vector<int> serially(60);
  batch.workspace_count = 1, batch.executor = nullptr;
  orchard_closer_than_all(&batch, 1, serially.data());
  EXPECT_EQ(serially, closer);
  orchard_pair* const pair = orchard_pair_new(cube.tree, ball.tree);
  for (std::size_t i = 0; i < 60; ++i) {
    const orchard_distance alone = orchard_measure(pair, &a[i], &b[i], 0.01);
    EXPECT_EQ(distances[i].lower, alone.lower) << i;
    EXPECT_EQ(distances[i].upper, alone.upper) << i;
    EXPECT_EQ(closer[i], orchard_closer_than(workspaces[0], cube.tree, &a[i], ball.tree, &b[i], 1, nullptr)) << i;
    if (i != 7) {
      EXPECT_EQ(closer[i] == 1, orchard_measure(pair, &a[i], &b[i], 0).lower <= 1) << i;
    }
  }
  EXPECT_EQ(closer[7], -1);
  EXPECT_EQ(distances[7].lower, 0);
  orchard_pair_free(pair);
  for (orchard_workspace* workspace : workspaces) orchard_workspace_free(workspace);
}

TEST(CInterface, SignsDistancesByWhetherTheSurfacesMeet) {
  const Tree cube(box({-1, -1, -1}, {1, 1, 1}));
  orchard_workspace* const workspace = orchard_workspace_new();
  const orchard_pose still = orchard_identity();
  for (const double x : {1.9, 1.99, 2.5, 4.0}) {
    orchard_pose moved = still;
    moved.translation[0] = x;
    const orchard_signed_distance d = orchard_measure_signed(workspace, cube.tree, &still, cube.tree, &moved, 1e-3);
    EXPECT_NEAR(d.lower, x - 2, 2e-3 * std::fabs(x - 2) + 1e-9) << x;
    EXPECT_LE(d.lower, d.upper) << x;
    EXPECT_NEAR(d.normal[0], 1, 1e-6) << x;
  }
  orchard_pose flat = still;
  flat.scale = 0;
  const orchard_signed_distance none = orchard_measure_signed(workspace, cube.tree, &still, cube.tree, &flat, 1e-3);
  EXPECT_FALSE(none.lower > 0);
  EXPECT_FALSE(none.upper < 0);
  orchard_workspace_free(workspace);
}

TEST(CInterface, HasContactsBeforeBodiesTouchAndSignedDistancesOfPoints) {
  const Tree cube(box({0, 0, 0}, {1, 1, 1}));
  orchard_workspace* const workspace = orchard_workspace_new();
  const orchard_pose still = orchard_identity();
  orchard_pose apart = still;
  apart.translation[0] = 1.25;
  orchard_distance near{};
  EXPECT_EQ(orchard_closer_than(workspace, cube.tree, &still, cube.tree, &apart, 0.5, &near), 1);
  EXPECT_NEAR(near.on_b[0] - near.on_a[0], 0.25, 1e-9);
  EXPECT_EQ(orchard_closer_than(workspace, cube.tree, &still, cube.tree, &apart, 0.2, &near), 0);
  EXPECT_EQ(orchard_contacts(workspace, cube.tree, &still, cube.tree, &apart, 0).count, 0u);
  orchard_manifold m = orchard_contacts(workspace, cube.tree, &still, cube.tree, &apart, 0.5);
  EXPECT_EQ(m.answer, ORCHARD_NO);
  ASSERT_EQ(m.count, 1u);
  EXPECT_NEAR(m.depth, -0.25, 1e-9);
  EXPECT_EQ(m.points[0].depth, m.depth);
  EXPECT_NEAR(m.normal[0], 1, 1e-9);
  apart.translation[0] = 0.75;
  m = orchard_contacts(workspace, cube.tree, &still, cube.tree, &apart, 0.5);
  EXPECT_EQ(m.answer, ORCHARD_YES);
  ASSERT_GT(m.count, 0u);
  for (std::uint32_t i = 0; i < m.count; ++i) EXPECT_LE(m.points[i].depth, m.depth);
  orchard_workspace_free(workspace);
  const double inside[3] = {0.5, 0.5, 0.9};
  double distance = 0, point[3], normal[3];
  EXPECT_EQ(orchard_signed_nearest_point(cube.tree, &still, inside, 9, &distance, point, normal, nullptr), 1);
  EXPECT_NEAR(distance, -0.1, 1e-6);
  EXPECT_NEAR(point[2], 1, 1e-6);
  EXPECT_NEAR(normal[2], 1, 1e-9);
  const double far[3] = {50, 0, 0};
  EXPECT_EQ(orchard_signed_nearest_point(cube.tree, &still, far, 9, nullptr, nullptr, nullptr, nullptr), 0);
}

TEST(CInterface, TellsWhichPartsOfARobotTouch) {
  const Tree link(box({-1, -0.1, -0.1}, {1, 0.1, 0.1}));
  const std::vector<const orchard_tree*> parts(4, link.tree);
  orchard_self_collision* const arm = orchard_self_collision_new(parts.data(), parts.size());
  orchard_workspace* const workspace = orchard_workspace_new();
  std::vector<orchard_pose> poses(4, orchard_identity());
  for (int i = 0; i < 4; ++i) poses[static_cast<size_t>(i)].translation[0] = 1.95 * i;  // neighbours overlap
  orchard_touch touches[2];
  EXPECT_EQ(orchard_self_collision_all(arm, workspace, poses.data(), touches, 2), 3u);
  EXPECT_EQ(touches[1].part_a, 1u);
  EXPECT_EQ(touches[1].part_b, 2u);
  EXPECT_EQ(touches[1].answer, ORCHARD_YES);
  EXPECT_NE(touches[1].triangle_a, ORCHARD_NO_TRIANGLE);
  orchard_self_collision_allow_touching(arm, workspace, poses.data());
  EXPECT_EQ(orchard_self_collision_first(arm, workspace, poses.data()).answer, ORCHARD_NO);
  EXPECT_EQ(orchard_self_collision_allow(arm, 2, 1, 0), 1);
  EXPECT_EQ(orchard_self_collision_allow(arm, 4, 1, 1), 0);
  const orchard_touch first = orchard_self_collision_first(arm, workspace, poses.data());
  EXPECT_EQ(first.part_a, 1u);
  EXPECT_EQ(first.part_b, 2u);
  poses[3].scale = 0;  // no pose: of its pairs that may not touch nothing is known
  EXPECT_EQ(orchard_self_collision_all(arm, workspace, poses.data(), touches, 2), 3u);
  EXPECT_EQ(touches[0].answer, ORCHARD_MAYBE);
  EXPECT_EQ(touches[0].part_b, 3u);
  orchard_workspace_free(workspace);
  orchard_self_collision_free(arm);
  orchard_self_collision_free(nullptr);
}

}  // namespace
