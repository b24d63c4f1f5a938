#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "orchard/geometry/atomic_file.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/annealing.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/tightened.h"
#include "orchard/spheretree/tree_io.h"
#include "orchard/spheretree/verify.h"
#include "support.h"
#include "support/query_of_trees.h"

// Trees that go deeper in one place than in another, on their way from the builders to the run-time.
namespace orchard {
namespace {

using namespace test;

struct Named {
  const char* name;
  SphereTree tree;
};

std::vector<Named> varying_trees(const Surface& surface) {
  const double R = surface.bounding_radius();
  Refinement refinement{0.3 * R, {{{surface.mesh().vertices[0], 0.2 * R}, 0.02 * R}}};
  const MedialAxis axis = axis_of(surface);
  AnnealingOptions annealing;
  annealing.refinement = refinement;
  annealing.max_accepted = annealing.max_rejected = 10;
  annealing.iterations_first = annealing.iterations = 8;
  TightenOptions tightening;
  tightening.effort = Effort::low;
  tightening.refinement = refinement;
  std::vector<Named> trees;
  trees.push_back({"octree", octree(surface, {.depth = 3, .refinement = refinement})});
  trees.push_back({"annealing", annealed_tree(surface, annealing).tree});
  trees.push_back({"tightened", tightened_tree(surface, points_of(surface), tightening).tree});
  for (const MergeClosing closing : {MergeClosing::refit, MergeClosing::growth}) {
    trees.push_back({"merging", merge_tree(surface, axis, {.refinement = refinement, .closing = closing}).tree});
    cover(trees.back().tree, surface);
  }
  return trees;
}

std::set<Index> leaf_levels(const SphereTree& tree) {
  std::set<Index> levels;
  for (const SphereNode& node : tree.nodes)
    if (node.child_count == 0) levels.insert(node.level);
  return levels;
}

// Whether any triangle of the surface, moved, meets one of it where it is.
bool meets_when_moved(const Surface& surface, const Vector& move) {
  std::vector<Index> met;
  for (Index i = 0; i < surface.mesh().triangles.size(); ++i) {
    auto corners = surface.corners(i);
    for (Point& corner : corners) corner += move;
    surface.triangles_overlapping(corners, met);
    if (!met.empty()) return true;
  }
  return false;
}

TEST(VaryingDepth, KeepsItsTextFileItsCertificateAndTheAnswersInTheRunTime) {
  const Surface surface(u_shape(0.3));
  const auto file = std::filesystem::temp_directory_path() / "orchard_varying_depth.sph";
  for (auto& [name, tree] : varying_trees(surface)) {
    EXPECT_GT(leaf_levels(tree).size(), 1u) << name;
    write_file(file, to_sph(tree));
    EXPECT_TRUE(same_tree(read_sph(file), tree)) << name;
    measure(tree, surface);
    runtime::PackedSphereTree loaded;
    ASSERT_EQ(runtime::load(runtime::serialize(pack(tree, surface)), loaded), runtime::LoadStatus::ok) << name;
    EXPECT_TRUE(verify(surface, loaded).ok()) << name;
    runtime::test::OwnNarrowPhase pair(loaded, loaded);
    int yes = 0, no = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      Random random(seed, 77);
      Vector move;
      for (double& x : move) x = random.uniform(-1.2, 1.2) * surface.bounding_radius();
      runtime::Pose pose;
      pose.translation = {move.x(), move.y(), move.z()};
      const runtime::Answer answer = runtime::collide(pair, runtime::Pose(), pose).answer;
      const bool meets = meets_when_moved(surface, move);
      EXPECT_EQ(answer, meets ? runtime::Answer::yes : runtime::Answer::no) << name << ", seed " << seed;
      ++(meets ? yes : no);
    }
    EXPECT_GT(yes, 0);
    EXPECT_GT(no, 0);
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace orchard
