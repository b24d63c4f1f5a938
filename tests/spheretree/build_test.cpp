#include "orchard/spheretree/build.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "orchard/geometry/error.h"
#include "support.h"

namespace orchard {
namespace {

TreeOptions small_builder(TreeMethod method) {
  if (method == TreeMethod::merging) return MergeOptions{.depth = 2};
  if (method == TreeMethod::octree) return OctreeOptions{.depth = 2};
  if (method == TreeMethod::tightened) return TightenOptions{.depth = 2, .effort = Effort::low};
  AnnealingOptions annealing = annealing_options(Effort::low);
  annealing.depth = 2;
  return annealing;
}

SphereTreeOptions small(TreeMethod method) {
  SphereTreeOptions options{.tree = small_builder(method)};
  options.medial.sampling.face_points = 1600;
  options.medial.sampling.edge_points = 400;
  options.samples_by_need = false;
  return options;
}

TEST(BuildSphereTree, ProvesWhatItReturnsWhateverTheMethod) {
  const Surface surface(test::l_shape());
  for (const TreeMethod method :
       {TreeMethod::tightened, TreeMethod::merging, TreeMethod::annealing, TreeMethod::octree}) {
    const SphereTreeBuild build = build_sphere_tree(surface, small(method));
    EXPECT_TRUE(build.certificate.ok());
    EXPECT_TRUE(verify(surface, build.packed).ok());
    EXPECT_EQ(build.packed.node_count, build.tree.nodes.size());
    EXPECT_EQ(build.medial.has_value(), samples_surface(method));
    test::expect_conservative(build.tree, surface, "L");
  }
}

TEST(BuildSphereTree, BuildsTheAxisThatBuildMedialAxisBuilds) {
  const Surface surface(test::u_shape(0.1));
  SphereTreeOptions options = small(TreeMethod::merging);
  options.medial.prune.angle = 0.5;
  options.medial.gap_repair.definition = GapDefinition::strict;
  const SphereTreeBuild tree = build_sphere_tree(surface, options);
  const MedialBuild medial = build_medial_axis(surface, options.medial);
  ASSERT_TRUE(tree.medial.has_value());
  EXPECT_EQ(tree.medial->axis.centers, medial.axis.centers);
  EXPECT_EQ(tree.medial->sampling.points, medial.sampling.points);
  EXPECT_LT(medial.axis.size(), medial.unpruned_vertices);
}

TEST(BuildSphereTree, TakesAsManyPointsAsTheTreeNeedsUnlessTold) {
  EXPECT_EQ(samples_needed(MergeOptions{}), 5000u);
  EXPECT_EQ(samples_needed(TightenOptions{.depth = 1}), 10'000u);
  EXPECT_EQ(samples_needed(TightenOptions{.depth = 4}), 81'920u);
  EXPECT_EQ(samples_needed(TightenOptions{.depth = 10}), 200'000u);
  const Surface surface(test::l_shape());
  SphereTreeOptions options = small(TreeMethod::merging);
  EXPECT_NEAR(build_sphere_tree(surface, options).medial->points, 2000, 20);
  options.samples_by_need = true;
  EXPECT_NEAR(build_sphere_tree(surface, options).medial->points, 5000, 50);
}

TEST(BuildSphereTree, TightensTheSameTreeWithAndWithoutAnAxis) {
  for (const double gap : {0.02, 0.2}) {  // the narrow one gets points by gap repair, which do not count
    const Surface surface(test::u_shape(gap));
    SphereTreeOptions options = small(TreeMethod::tightened);
    const SphereTreeBuild with = build_sphere_tree(surface, options);
    options.axis = false;
    const SphereTreeBuild without = build_sphere_tree(surface, options);
    EXPECT_TRUE(test::same_tree(with.tree, without.tree));
    EXPECT_TRUE(with.medial.has_value());
    EXPECT_FALSE(without.medial.has_value());
    EXPECT_EQ(with.points, without.points);
  }
  SphereTreeOptions merging = small(TreeMethod::merging);
  merging.axis = false;
  EXPECT_TRUE(build_sphere_tree(Surface(test::u_shape(0.2)), merging).medial.has_value());
}

TEST(BuildSphereTree, WithoutAnAxisRefusesWhatIsNotSolid) {
  TriangleMesh open = test::l_shape();
  open.triangles.pop_back();
  SphereTreeOptions options = small(TreeMethod::tightened);
  options.axis = false;
  EXPECT_THROW(build_sphere_tree(Surface(open), options), InputError);
}

TEST(BuildSphereTree, BuildsFromAForeignAxis) {
  const Surface surface(test::u_shape(0.2));
  MedialMesh foreign = medial_mesh(build_medial_axis(surface, {.sampling = {.face_points = 400}}).axis);
  foreign.centers.push_back(Point(99, 0, 0));
  foreign.radii.push_back(1);
  for (const TreeMethod method : {TreeMethod::tightened, TreeMethod::merging}) {
    MedialBuildInput input;
    input.mesh = foreign;
    const SphereTreeBuild build = build_sphere_tree(surface, small(method), {}, input);
    EXPECT_TRUE(build.certificate.ok());
    EXPECT_EQ(build.medial->balls_refused, 1u);
    EXPECT_EQ(build.medial->axis.size(), foreign.size() - 1);
    test::expect_conservative(build.tree, surface, "U");
  }
}

TEST(BuildSphereTree, FromTheDiagramOfABuildIsTheSameTree) {
  const Surface surface(test::u_shape(0.2));
  const SphereTreeOptions options = small(TreeMethod::tightened);
  SphereTreeBuild first = build_sphere_tree(surface, options);
  MedialBuildInput input;
  input.diagram = {std::move(first.medial->diagram), std::move(first.medial->sampling)};
  EXPECT_TRUE(test::same_tree(first.tree, build_sphere_tree(surface, options, {}, std::move(input)).tree));
}

TEST(BuildSphereTreeWithin, GivesACertifiedTreeWhateverTheLimitAndATighterOneForMoreTime) {
  const Surface surface(test::l_shape());
  SphereTreeOptions options = small(TreeMethod::tightened);
  options.tree = TightenOptions{.depth = 1};
  const SphereTreeBuild none = build_sphere_tree_within(0, surface, options);
  EXPECT_TRUE(none.certificate.ok());
  EXPECT_EQ(method_of(none.tree_options), TreeMethod::octree);
  SphereTreeBuild some = build_sphere_tree_within(2, surface, options);
  EXPECT_TRUE(some.certificate.ok());
  EXPECT_LE(overall_inaccuracy(some.tree), overall_inaccuracy(none.tree));
  test::expect_conservative(some.tree, surface, "L");
}

TEST(BuildSphereTreeWithin, RefusesLimitsThatAreNone) {
  const Surface surface(test::l_shape());
  for (const double seconds : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(build_sphere_tree_within(seconds, surface, small(TreeMethod::tightened)), InputError) << seconds;
}

TEST(BuildSphereTreeWithin, RefusesTheOptionsOfAnotherBuilder) {
  const Surface surface(test::l_shape());
  for (const TreeMethod method : {TreeMethod::merging, TreeMethod::annealing, TreeMethod::octree})
    EXPECT_THROW(build_sphere_tree_within(1, surface, small(method)), InputError);
}

TEST(TreeOptionsOfABuild, TellTheMethodAndTheDepth) {
  for (const TreeMethod method :
       {TreeMethod::tightened, TreeMethod::merging, TreeMethod::annealing, TreeMethod::octree}) {
    EXPECT_EQ(method_of(small_builder(method)), method);
    EXPECT_EQ(depth_of(small_builder(method)), 2u);
  }
  EXPECT_EQ(depth_of(TightenOptions{.depth = 4, .spheres = {8, 64, 512, 1000}}), 4u);
}

TEST(BuildSphereTreeWithin, StopsWhenCancelled) {
  const Surface surface(test::l_shape());
  EXPECT_THROW(build_sphere_tree_within(1000, surface, small(TreeMethod::tightened),
                                        [](std::string_view, double) { return false; }),
               Cancelled);
}

TEST(BuildSphereTree, RefusesTwoInputsAtOnce) {
  const Surface surface(test::l_shape());
  MedialBuildInput input;
  input.sampling.emplace();
  input.mesh.emplace();
  EXPECT_THROW(build_sphere_tree(surface, small(TreeMethod::merging), {}, input), InputError);
}

}  // namespace
}  // namespace orchard
