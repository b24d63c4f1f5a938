#include "orchard/medial/promise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/build.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr AxisPromise kStrict{.open = 0.002, .protrusion = 0.001, .topology = true};

TEST(Promise, OfAnExactAxisIsKeptAndProven) {
  const test::KnownAxis box = test::known_box({1, 2, 3});
  const PromiseCheck check = check_promise(Surface(box.solid), box.axis, kStrict);
  EXPECT_TRUE(check.kept());
  EXPECT_TRUE(check.proven());
  EXPECT_LE(check.open_upper, 0.002);
  EXPECT_LE(check.protrusion_upper, 0.001);
}

// The largest ball of a box 1 x 1 x 3 leaves the corners open by the half of its diagonal less the radius.
TEST(Promise, NamesHowFarOneBallLeavesABoxOpen) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 3}));
  const MedialMesh ball{.centers = {{0.5, 0.5, 1.5}}, .radii = {0.5}, .edges = {}, .triangles = {}};
  const PromiseCheck check = check_promise(surface, ball, kStrict);
  const double diagonal = std::sqrt(11.0);
  EXPECT_FALSE(check.keeps_open());
  EXPECT_TRUE(check.keeps_protrusion());
  EXPECT_TRUE(check.keeps_topology());
  EXPECT_FALSE(check.kept());
  EXPECT_NEAR(check.open, (diagonal / 2 - 0.5) / diagonal, 1e-12);
}

TEST(Promise, NamesHowFarABallSticksOut) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 3}));
  const MedialMesh ball{.centers = {{0.5, 0.5, 1.5}}, .radii = {0.6}, .edges = {}, .triangles = {}};
  const PromiseCheck check = check_promise(surface, ball, {.open = {}, .protrusion = 0.01, .topology = false});
  EXPECT_TRUE(check.keeps_open());
  EXPECT_NEAR(check.protrusion, 0.1 / std::sqrt(11.0), 1e-4);
}

TEST(Promise, OfTheTopologyIsBrokenByABallInATorus) {
  const Surface surface(test::torus(24, 12));
  const MedialMesh ball{.centers = {{1, 0, 0}}, .radii = {0.3}, .edges = {}, .triangles = {}};
  EXPECT_FALSE(check_promise(surface, ball, kStrict).keeps_topology());
  EXPECT_TRUE(check_promise(surface, ball, {}).kept()) << "nothing was promised";
}

TEST(Promise, GoesByTheOptions) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  MedialBuildOptions options{.axis = {.keep_topology = true}, .refine = RefineOptions{}};
  const AxisPromise refined = axis_promise(surface, options, 5000);
  ASSERT_TRUE(refined.open && refined.protrusion);
  EXPECT_NEAR(*refined.open, 7 * 6.0 / 5000 / 3 + 5e-4, 1e-12) << "what the points can show, and the tolerance";
  EXPECT_NEAR(*axis_promise(surface, options, 100'000).open, 1.65e-3 + 5e-4, 1e-12);
  EXPECT_EQ(*refined.protrusion, 1e-3);
  EXPECT_TRUE(refined.topology);
  options.prune.angle = 0.3;
  EXPECT_FALSE(axis_promise(surface, options, 5000).open);
  options.prune.angle = 0;
  options.refine->reach_rounds = 0;
  EXPECT_FALSE(axis_promise(surface, options, 5000).open);
  options.axis.keep_topology = false;
  EXPECT_FALSE(axis_promise(surface, options, 5000).topology);
  options.refine.reset();
  EXPECT_FALSE(axis_promise(surface, options, 5000).protrusion);
}

TEST(Promise, IsRefusedForAMeshThatIsNoSolid) {
  const MedialMesh ball{.centers = {{0.5, 0.5, 0.5}}, .radii = {0.5}, .edges = {}, .triangles = {}};
  EXPECT_THROW(check_promise(Surface(test::open_box()), ball, kStrict), InputError);
}

TEST(Promise, IsCheckedByEveryBuildUnlessThatIsSwitchedOff) {
  const Surface surface(test::l_shape());
  MedialBuildOptions options{.sampling = {.face_points = 400, .edge_points = 100}, .refine = RefineOptions{}};
  const MedialBuild build = build_medial_axis(surface, options);
  EXPECT_TRUE(build.promise.kept());
  EXPECT_GT(build.promise.open_upper, 0);
  options.check_promise = false;
  EXPECT_EQ(build_medial_axis(surface, options).promise.open_upper, 0);
}

}  // namespace
}  // namespace orchard
