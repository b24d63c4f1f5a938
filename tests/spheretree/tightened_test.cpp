#include "orchard/spheretree/tightened.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <string_view>
#include <thread>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/outside_volume.h"
#include "orchard/spheretree/redundancy.h"
#include "support.h"
#include "tightened/tree_looseness.h"

namespace orchard {
namespace {

using namespace test;

std::vector<Index> level_counts(const SphereTree& tree) {
  std::vector<Index> counts(tree.depth() + 1, 0);
  for (const SphereNode& node : tree.nodes) ++counts[node.level];
  return counts;
}

TEST(TightenedTree, IsConservativeOnEveryShape) {
  for (const Shape& shape : shapes()) {
    const Surface surface(shape.mesh);
    const SphereTree tree = tightened_tree(surface, points_of(surface, 1000), {.depth = 2, .effort = Effort::low}).tree;
    EXPECT_EQ(tree.depth(), 2) << shape.name;
    expect_conservative(tree, surface, shape.name);
  }
}

TEST(TightenedTree, KeepsToTheBudgetOfEachLevelAndOfEachNode) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 3000);
  for (const Index branching : {2u, 5u, 8u, 17u}) {
    const SphereTree tree =
        tightened_tree(surface, points, {.depth = 2, .branching = branching, .effort = Effort::low}).tree;
    expect_conservative(tree, surface, "U");
    const auto counts = level_counts(tree);
    ASSERT_EQ(counts.size(), 3);
    EXPECT_LE(counts[1], branching);
    EXPECT_LE(counts[2], branching * branching);
    for (const SphereNode& node : tree.nodes) EXPECT_LE(node.child_count, std::max(kMaxFanOut, 2 * branching));
  }
}

TEST(TightenedTree, GoesAsDeepAsAskedWithAnyBranching) {
  const Surface surface(torus(24, 12));
  const SurfaceSampling points = points_of(surface, 1500);
  for (const auto& [branching, depth] : {std::pair<Index, Index>{2, 6}, {4, 4}, {64, 1}}) {
    const SphereTree tree =
        tightened_tree(surface, points, {.depth = depth, .branching = branching, .effort = Effort::low}).tree;
    expect_conservative(tree, surface, "torus");
    EXPECT_EQ(tree.depth(), depth);
    const auto counts = level_counts(tree);
    Index max = 1;
    for (std::size_t level = 1; level < counts.size(); ++level) {
      max *= branching;
      EXPECT_LE(counts[level], max);
      EXPECT_GT(counts[level], counts[level - 1]);
    }
  }
}

// So many levels and balls are asked for that the samples end them.
TEST(TightenedTree, GoesNoDeeperThanItsSamplesMakeWorthWhile) {
  const Surface surface(torus(24, 12));
  const SphereTree tree =
      tightened_tree(surface, points_of(surface, 1500), {.depth = 7, .branching = 5, .effort = Effort::low}).tree;
  expect_conservative(tree, surface, "torus");
  EXPECT_GE(tree.depth(), 3);
  EXPECT_LT(tree.depth(), 7);
  const auto counts = level_counts(tree);
  for (std::size_t level = 1; level < counts.size(); ++level) EXPECT_GT(counts[level], 1.3 * counts[level - 1]);
}

TEST(TightenedTree, HasNoSphereOfNoSizeAndOnceThinnedNoneThatCanGo) {
  const Surface surface(u_shape(0.3));
  SphereTree tree = tightened_tree(surface, points_of(surface, 2000), {.depth = 2, .effort = Effort::low}).tree;
  remove_redundant(tree, surface);
  for (const SphereNode& node : tree.nodes) EXPECT_GT(node.sphere.radius, 0.01 * surface.bounding_radius());
  for (Index node = 1; node < tree.nodes.size(); ++node) {
    // Without its leaves, a node and all below it hold nothing.
    std::vector<PathBall> balls = path_balls(tree);
    std::vector<char> gone(balls.size(), 0);
    for (Index i = node; i < balls.size(); ++i) {
      gone[i] = i == node || gone[balls[i].parent];
      if (gone[i]) balls[i].leaf = false;
    }
    EXPECT_FALSE(surface_coverage(surface, balls).complete()) << node;
  }
}

TEST(TightenedTree, FitsTighterThanMerging) {
  for (const TriangleMesh& mesh : {torus(32, 16), l_shape(), u_shape(0.3)}) {
    const Surface surface(mesh);
    const SurfaceSampling points = points_of(surface, 3000);
    SphereTree tight = tightened_tree(surface, points, {.depth = 2, .effort = Effort::low}).tree;
    SphereTree merged = merge_tree(surface, axis_of(surface, 3000), {.depth = 2, .closing = MergeClosing::growth}).tree;
    cover(merged, surface);
    measure(tight, surface);
    measure(merged, surface);
    const auto ours = level_figures(tight, surface.bounding_radius());
    const auto theirs = level_figures(merged, surface.bounding_radius());
    for (std::size_t level = 1; level < ours.size(); ++level) {
      EXPECT_LT(ours[level].mean_inaccuracy, theirs[level].mean_inaccuracy) << level;
      EXPECT_LT(ours[level].max_inaccuracy, theirs[level].max_inaccuracy) << level;
    }
  }
}

TEST(TightenedTree, ABallOfABallIsAlmostExact) {
  const Surface surface(icosphere(3));
  SphereTree tree = tightened_tree(surface, points_of(surface, 1000), {.depth = 1, .branching = 2}).tree;
  measure(tree, surface);
  for (const SphereNode& node : tree.nodes) EXPECT_LT(node.inaccuracy, 0.02 * surface.bounding_radius());
}

TEST(TightenedTree, RefinesOnlyWhatIsNotAccurateEnough) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 3000);
  TightenOptions options{.depth = 3, .effort = Effort::low};
  options.refinement.error = 0.08 * surface.bounding_radius();
  SphereTree tree = tightened_tree(surface, points, options).tree;
  expect_conservative(tree, surface, "U");
  measure(tree, surface);
  ASSERT_EQ(tree.depth(), 3);
  Index leaves_above = 0;
  for (const SphereNode& node : tree.nodes) {
    leaves_above += node.child_count == 0 && node.level < tree.depth();
    if (node.child_count == 0) continue;
    EXPECT_GT(node.sphere.radius + node.center_distance, options.refinement.error);
  }
  EXPECT_GT(leaves_above, 0);
}

TEST(TightenedTree, RefinesARegionMore) {
  const Surface surface(box(Point(0, 0, 0), Point(10, 1, 1)));
  const SurfaceSampling points = points_of(surface, 3000);
  TightenOptions options{.depth = 3, .effort = Effort::low};
  options.refinement.error = 100;
  options.refinement.regions.push_back({{Point(10, 0.5, 0.5), 0.5}, 1e-3});
  const SphereTree tree = tightened_tree(surface, points, options).tree;
  expect_conservative(tree, surface, "bar");
  EXPECT_EQ(tree.depth(), 3);
  for (const SphereNode& node : tree.nodes) {
    if (node.child_count == 0) continue;
    EXPECT_LE((node.sphere.center - Point(10, 0.5, 0.5)).norm(), node.sphere.radius + 0.5);
  }
}

TEST(TightenedTree, EveryObjectiveIsConservativeAndLowersWhatItIsFor) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 3000);
  struct Figures {
    double mean, max, outside;
  };
  const auto figures = [&](Objective objective) {
    SphereTree tree = tightened_tree(surface, points, {.depth = 2, .effort = Effort::low, .objective = objective}).tree;
    expect_conservative(tree, surface, "U");
    measure(tree, surface);
    std::vector<Sphere> spheres;
    for (const SphereNode& node : tree.nodes)
      if (node.level == 2) spheres.push_back(node.sphere);
    const LevelFigures level = level_figures(tree, surface.bounding_radius())[2];
    return Figures{level.mean_inaccuracy, level.max_inaccuracy, outside_volume(surface, spheres)};
  };
  const Figures maximum = figures(Objective::maximum), mean = figures(Objective::mean);
  const Figures volume = figures(Objective::volume);
  EXPECT_LT(mean.mean, maximum.mean * 1.02);
  EXPECT_LT(maximum.max, mean.max * 1.02);
  EXPECT_LT(volume.outside, mean.outside * 1.02);
}

TEST(TightenedTree, IsTheSameOnOneTwoAndSevenThreads) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 1000);
  std::vector<SphereTree> trees;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    trees.push_back(tightened_tree(surface, points, {.depth = 2, .branching = 3}).tree);
  }
  EXPECT_TRUE(same_tree(trees[0], trees[1]));
  EXPECT_TRUE(same_tree(trees[0], trees[2]));
}

TEST(TightenedTree, AnotherSeedIsAnotherTree) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 1000);
  TightenOptions options{.depth = 2, .effort = Effort::low};
  const SphereTree one = tightened_tree(surface, points, options).tree;
  EXPECT_TRUE(same_tree(one, tightened_tree(surface, points, options).tree));
  options.seed = 2;
  EXPECT_FALSE(same_tree(one, tightened_tree(surface, points, options).tree));
}

TEST(TightenedTree, RefusesABranchingThatIsNoBranching) {
  const Surface surface(torus(24, 12));
  const SurfaceSampling points = points_of(surface);
  EXPECT_THROW(tightened_tree(surface, points, {.branching = 1}), InputError);
  EXPECT_THROW(tightened_tree(surface, points, {.branching = 1025}), InputError);
}

TEST(TightenedTree, RefusesPointsThatAreNoneOrNotOfTheSurface) {
  const Surface surface(torus(24, 12));
  const SurfaceSampling points = points_of(surface);
  EXPECT_THROW(tightened_tree(surface, SurfaceSampling{}), InputError);
  SurfaceSampling torn = points, lost = points;
  torn.origins.pop_back();
  lost.points.front() *= 2;
  for (const SurfaceSampling& wrong : {torn, lost}) EXPECT_THROW(tightened_tree(surface, wrong), Error);
}

TEST(TightenedTree, KeepsToTheNumbersOfSpheresGivenForEachLevel) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 2000);
  TightenOptions options{.depth = 2, .effort = Effort::low};
  options.spheres = {5, 40};
  const SphereTree tree = tightened_tree(surface, points, options).tree;
  expect_conservative(tree, surface, "U");
  const auto counts = level_counts(tree);
  ASSERT_EQ(counts.size(), 3u);
  EXPECT_LE(counts[1], 5u);
  EXPECT_LE(counts[2], 40u);
  EXPECT_GT(counts[2], 30u);
  for (const std::vector<Index>& wrong : {std::vector<Index>{5}, {1, 40}, {5, 5}, {5, 400}, {2000, 3000}}) {
    options.spheres = wrong;
    EXPECT_THROW(tightened_tree(surface, points, options), InputError);
  }
}

TEST(TightenedTree, MakesOneLevelOfMoreSpheresThanALevelUsuallyHas) {
  const Surface surface(torus(24, 12));
  const SphereTree tree =
      tightened_tree(surface, points_of(surface, 1500), {.depth = 1, .branching = 100, .effort = Effort::low}).tree;
  expect_conservative(tree, surface, "torus");
  EXPECT_GT(tree.nodes[0].child_count, 64u);
  EXPECT_LE(tree.nodes[0].child_count, 100u);
}

TEST(TightenedTree, IsTheSameForAMeshThatIsScaledOrMoved) {
  struct Frame {
    double factor;
    Vector offset;
  };
  const TriangleMesh mesh = u_shape(0.3);
  const SurfaceSampling points = points_of(Surface(mesh), 1000);
  const auto tree_in = [&](const Frame& frame) {
    SurfaceSampling moved = points;
    for (Point& point : moved.points) point = frame.factor * point + frame.offset;
    const Surface surface(transformed(mesh, frame.factor, frame.offset));
    SphereTree tree = tightened_tree(surface, moved, {.depth = 2, .effort = Effort::low}).tree;
    expect_conservative(tree, surface, "moved U");
    return tree;
  };
  const SphereTree tree = tree_in({1, Vector::Zero()});
  for (const Frame& frame : {Frame{1024, Vector::Zero()}, Frame{1e-3, Vector::Zero()}, Frame{1, Vector(100, -7, 31)}}) {
    const SphereTree other = tree_in(frame);
    ASSERT_EQ(tree.nodes.size(), other.nodes.size()) << frame.factor;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      EXPECT_EQ(tree.nodes[i].parent, other.nodes[i].parent);
      const double radius = frame.factor * tree.nodes[i].sphere.radius;
      EXPECT_NEAR(other.nodes[i].sphere.radius, radius, frame.factor == 1024 ? 0 : 1e-9 * radius) << frame.factor;
      const Point center = frame.factor * tree.nodes[i].sphere.center + frame.offset;
      EXPECT_LE((other.nodes[i].sphere.center - center).norm(), frame.factor == 1024 ? 0 : 1e-9 * radius + 1e-12);
    }
  }
}

TEST(TightenedTree, IsTheSameWhereEvenThePointsAreSampledInAnotherFrame) {
  const TriangleMesh mesh = torus(24, 12);
  const auto tree_in = [&](double factor, const Vector& offset) {
    const Surface surface(transformed(mesh, factor, offset));
    return tightened_tree(surface, points_of(surface, 1000), {.depth = 2, .effort = Effort::low}).tree;
  };
  const SphereTree tree = tree_in(1, Vector::Zero());
  for (const auto& [factor, offset] : {std::pair{1000.0, Vector(0, 0, 0)}, {2.54, Vector(10, -7, 3)}}) {
    const SphereTree other = tree_in(factor, offset);
    ASSERT_EQ(tree.nodes.size(), other.nodes.size()) << factor;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      EXPECT_EQ(tree.nodes[i].parent, other.nodes[i].parent);
      const double radius = factor * tree.nodes[i].sphere.radius;
      EXPECT_NEAR(other.nodes[i].sphere.radius, radius, 1e-9 * radius) << factor;
    }
  }
}

// Starts of the first level are searched side by side.
TEST(TightenedTree, ReportsProgressOnTheCallersThreadAndNeverBack) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 500);
  const std::thread::id caller = std::this_thread::get_id();
  for (const Effort effort : {Effort::standard, Effort::high}) {
    double last = 0;
    const TightenOptions options{.depth = 2, .branching = 3, .effort = effort};
    tightened_tree(surface, points, options, [&](std::string_view, double fraction) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_GE(fraction, last);
      EXPECT_LE(fraction, 1);
      last = fraction;
      return true;
    });
    EXPECT_GT(last, 0.5);
  }
}

TEST(TightenedTree, StopsWheneverItIsCancelled) {
  const Surface surface(u_shape(0.3));
  const SurfaceSampling points = points_of(surface, 1000);
  for (const double at : {0.05, 0.2, 0.45, 0.7}) {
    bool reached = false;
    const auto until = [&](std::string_view, double fraction) {
      EXPECT_FALSE(reached);
      reached = fraction >= at;
      return !reached;
    };
    EXPECT_THROW(tightened_tree(surface, points, {.depth = 2, .branching = 4}, until), Cancelled) << at;
  }
}

TEST(TightenedTree, StopsWhenCancelled) {
  const Surface surface(torus(24, 12));
  const SurfaceSampling points = points_of(surface);
  EXPECT_THROW(tightened_tree(surface, points, {}, [](std::string_view, double) { return false; }), Cancelled);
}

// Boxes on a lattice: balls that hold many reach far beyond their inaccuracy.
TriangleMesh lattice_of_parts(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n * n * n; ++i) {
    const int column = i % n, row = i / n % n, layer = i / (n * n);
    const Point at(column, row, layer);
    const TriangleMesh part = box(at, at + Vector::Constant(0.4));
    const auto first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  }
  return mesh;
}

TEST(TightenedTree, HasNoLevelLooserThanTheOctreesOrThanTheOneAbove) {
  const Surface surface(lattice_of_parts(4));
  SphereTree tree = tightened_tree(surface, points_of(surface, 2000), {.depth = 2}).tree;
  SphereTree cubes = octree(surface, {.depth = 2});
  expect_conservative(tree, surface, "lattice");
  measure(tree, surface);
  measure(cubes, surface);
  const auto levels = level_figures(tree, surface.bounding_radius());
  const auto octrees = level_figures(cubes, surface.bounding_radius());
  constexpr double kSame = 2e-4;
  for (std::size_t level = 1; level < levels.size(); ++level) {
    for (const LevelFigures& other : {levels[level - 1], octrees[level]}) {
      EXPECT_LE(levels[level].mean_inaccuracy, other.mean_inaccuracy + kSame) << level;
      EXPECT_LE(levels[level].max_inaccuracy, other.max_inaccuracy + kSame) << level;
    }
  }
}

TEST(TightenedTree, IsLooserInNoFigureWithHighEffort) {
  const Surface surface(torus(9, 5));
  const SurfaceSampling points = points_of(surface, 500);
  const auto figures = [&](Effort effort) {
    SphereTree tree = tightened_tree(surface, points, {.depth = 2, .branching = 4, .effort = effort}).tree;
    expect_conservative(tree, surface, "torus");
    remove_redundant(tree, surface);
    measure(tree, surface);
    std::vector<std::array<double, 3>> levels;
    for (const LevelFigures& level : level_figures(tree, surface.bounding_radius())) {
      std::vector<Sphere> spheres;
      for (const SphereNode& node : tree.nodes)
        if (node.level == levels.size()) spheres.push_back(node.sphere);
      levels.push_back({level.mean_inaccuracy, level.max_inaccuracy, outside_volume(surface, spheres)});
    }
    return levels;
  };
  const auto standard = figures(Effort::standard), high = figures(Effort::high);
  ASSERT_EQ(high.size(), standard.size());
  constexpr double kRounding = 1e-9;
  for (std::size_t level = 0; level < high.size(); ++level)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(high[level][i], standard[level][i] * (1 + kRounding)) << level << i;
}

// A root with two children that hold everything and a small one that is redundant but tight: without it, or with it, as
// the finished tree will be.
TEST(TreeLooseness, CountsRedundantSpheresWhereTheFinishedTreeKeepsThem) {
  const Surface surface(torus(16, 8));
  const Sphere& ball = surface.bounding_ball();
  SphereTree tree;
  tree.nodes.push_back({.sphere = {ball.center, 1.1 * ball.radius}, .first_child = 1, .child_count = 3});
  for (const double factor : {1.2, 0.05, 1.3})
    tree.nodes.push_back({.sphere = {ball.center, factor * ball.radius}, .parent = 0, .level = 1});
  SphereTree compared = octree(surface, {.depth = 1}), whole = tree, lean = tree;
  for (SphereTree* measured : {&compared, &whole}) measure(*measured, surface);
  remove_redundant(lean, surface);
  measure(lean, surface);
  ASSERT_LT(lean.nodes.size(), tree.nodes.size());
  EXPECT_TRUE(detail::is_loosened(lean, compared));
  EXPECT_EQ(detail::looseness_by_level(tree, compared, surface)[1].mean, level_figures(whole, 1)[1].mean_inaccuracy);
  // Trees that do not go on everywhere are compared with no octree, and keep nothing that is redundant.
  EXPECT_EQ(detail::looseness_by_level(tree, {}, surface)[1].mean, level_figures(lean, 1)[1].mean_inaccuracy);
}

TEST(TightenedTree, GivesEachOfManyPartsASphereOfItsOwn) {
  const Surface surface(lattice_of_parts(5));
  const double of_part = 0.2 * (std::sqrt(3.0) - 1) / surface.bounding_radius();
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SphereTree tree =
        tightened_tree(surface, points_of(surface, 4000), {.depth = 1, .spheres = {125}, .seed = seed}).tree;
    measure(tree, surface);
    const LevelFigures level = level_figures(tree, surface.bounding_radius()).back();
    EXPECT_EQ(level.spheres, 125) << seed;
    EXPECT_LE(level.max_inaccuracy, 1.01 * of_part) << seed;
  }
}

}  // namespace
}  // namespace orchard
