// More than 300 lines: the ways to damage a packed tree and the sampling oracle that judges the damage, which most
// tests here share, are a third of the file.
#include "orchard/spheretree/verify.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>

#include "orchard/covering/inaccuracy.h"
#include "orchard/covering/incremental_cover.h"
#include "orchard/spheretree/certify.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/redundancy.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;
using runtime::PackedSphereTree;

PackedSphereTree packed_tree(const Surface& surface) {
  SphereTree tree = merge_tree(surface, axis_of(surface), {.depth = 2, .closing = MergeClosing::growth}).tree;
  cover(tree, surface);
  measure(tree, surface);
  return pack(tree, surface);
}

TEST(Verify, AcceptsWhatIsBuiltAtAnyScaleAndOffset) {
  for (const TriangleMesh& mesh : {torus(24, 12), l_shape(), transformed(u_shape(0.3), 1, Vector(1e6, 3e6, -2e6)),
                                   transformed(torus(16, 8), 1e-6, Vector::Zero())}) {
    const Surface surface(mesh);
    const Verification result = verify(surface, packed_tree(surface));
    EXPECT_TRUE(result.ok());
    EXPECT_TRUE(result.violations.empty());
    EXPECT_EQ(result.triangles, mesh.triangles.size());
    SphereTree tree = octree(surface);
    measure(tree, surface);
    EXPECT_TRUE(verify(surface, pack(tree, surface)).ok());
  }
}

TEST(Verify, AcceptsTheOctreeOfAnOpenSurface) {
  const Surface surface(open_box());
  SphereTree tree = octree(surface);
  measure(tree, surface);
  EXPECT_TRUE(verify(surface, pack(tree, surface)).ok());
}

TEST(Verify, RejectsEachKindOfDamage) {
  const Surface surface(l_shape());
  const PackedSphereTree good = packed_tree(surface);
  ASSERT_TRUE(verify(surface, good).ok());
  const auto radius = static_cast<float>(good.bounding_radius);
  struct Damage {
    const char* name;
    std::function<void(PackedSphereTree&)> apply;
  };
  const std::vector<Damage> damages{
      {"all leaves moved",
       [&](PackedSphereTree& t) {
         for (std::size_t b = 2; b < t.blocks.size(); ++b)
           for (float& x : t.blocks[b].x) x += 0.05f * radius;
       }},
      {"radii shrunk",
       [&](PackedSphereTree& t) {
         for (std::size_t b = 1; b < t.blocks.size(); ++b)
           for (float& r : t.blocks[b].radius) r *= r > 0 ? 0.9f : 1.0f;
       }},
      {"a distance lowered", [&](PackedSphereTree& t) { t.blocks[1].depth[0] -= 1e-4f * radius; }},
      {"a bound lowered", [&](PackedSphereTree& t) { t.blocks[0].error[0] *= 0.5f; }},
      {"a leaf's triangles dropped",
       [&](PackedSphereTree& t) {
         for (auto& link : t.blocks.back().link)
           if (link & runtime::kLeafBit) link = runtime::kEmptyLeaf;
       }},
      {"children swapped", [&](PackedSphereTree& t) { std::swap(t.blocks[1].link[0], t.blocks[1].link[1]); }},
      {"a vertex moved", [&](PackedSphereTree& t) { t.vertices[0][0] += 1e-3f * radius; }},
      {"a triangle exchanged", [&](PackedSphereTree& t) { std::swap(t.triangles[0][0], t.triangles[0][1]); }},
      {"a triangle lost", [&](PackedSphereTree& t) { t.triangles.pop_back(); }},
  };
  for (const Damage& damage : damages) {
    PackedSphereTree tree = good;
    damage.apply(tree);
    const Verification result = verify(surface, tree);
    EXPECT_FALSE(result.ok()) << damage.name;
    EXPECT_FALSE(result.violations.empty()) << damage.name;
  }
}

// A tree without a node to spare: what is taken from a leaf is missed somewhere.
PackedSphereTree lean_tree(const Surface& surface) {
  SphereTree tree = merge_tree(surface, axis_of(surface), {.depth = 2, .closing = MergeClosing::growth}).tree;
  cover(tree, surface);
  remove_redundant(tree, surface);
  measure(tree, surface);
  return pack(tree, surface);
}

// The same with every radius as small as the path rule allows, given the others.
PackedSphereTree tight_tree(const Surface& surface) {
  SphereTree tree = merge_tree(surface, axis_of(surface), {.depth = 2, .closing = MergeClosing::growth}).tree;
  cover(tree, surface);
  remove_redundant(tree, surface);
  IncrementalCover kept(surface, path_balls(tree));
  const double finest = 1e-8 * surface.bounding_radius();
  for (Index i = 0; i < tree.nodes.size(); ++i) {
    Sphere& sphere = tree.nodes[i].sphere;
    double low = 0, high = sphere.radius;
    while (high - low > finest) {
      const double middle = (low + high) / 2;
      (kept.try_change(i, {sphere.center, middle}) ? high : low) = middle;
    }
    sphere.radius = high;
  }
  measure(tree, surface);
  return pack(tree, surface);
}

Point center_of(const PackedSphereTree& tree, std::size_t block, std::size_t lane) {
  const auto& b = tree.blocks[block];
  return Point(tree.origin[0], tree.origin[1], tree.origin[2]) + Vector(b.x[lane], b.y[lane], b.z[lane]);
}

void move_center(PackedSphereTree& tree, std::size_t block, std::size_t lane, const Vector& step) {
  auto& b = tree.blocks[block];
  b.x[lane] += static_cast<float>(step.x());
  b.y[lane] += static_cast<float>(step.y());
  b.z[lane] += static_cast<float>(step.z());
}

// Calls visit(block, lane) for every node but the root.
template <class Visit>
void for_each_child(const PackedSphereTree& tree, Visit visit) {
  for (std::size_t block = 1; block < tree.blocks.size(); ++block)
    for (std::size_t lane = 0; lane < runtime::kBlockWidth; ++lane)
      if (tree.blocks[block].radius[lane] >= 0) visit(block, lane);
}

// Whether sampling finds nothing wrong with a tree: every point in a path region of a leaf that lists its triangle.
bool samples_find_nothing(const Surface& surface, const PackedSphereTree& tree) {
  const auto balls = path_balls(tree);
  const Point origin(tree.origin[0], tree.origin[1], tree.origin[2]);
  for (const Point& point : points_on(surface, 40, 3))
    if (path_distance(point - origin, balls) > 0) return false;
  return true;
}

TEST(Verify, RejectsEveryChildThatIsMovedOutwardByATenThousandthOfTheRadius) {
  for (const TriangleMesh& mesh : {l_shape(), torus(24, 12)}) {
    const Surface surface(mesh);
    const PackedSphereTree good = lean_tree(surface);
    ASSERT_TRUE(verify(surface, good).ok());
    for_each_child(good, [&](std::size_t block, std::size_t lane) {
      ClosestPoint nearest;
      const Point center = center_of(good, block, lane);
      const double side = surface.signed_distance(center, nearest) < 0 ? 1 : -1;
      const Vector outward = side * (nearest.position - center).normalized();
      PackedSphereTree tree = good;
      move_center(tree, block, lane, 1e-4 * good.bounding_radius * outward);
      EXPECT_FALSE(verify(surface, tree).ok()) << block << " " << lane;
    });
  }
}

TEST(Verify, RejectsEveryRadiusThatIsShrunkByATenThousandthWhereNoneIsLooser) {
  const Surface surface(torus(16, 8));
  const PackedSphereTree good = tight_tree(surface);
  ASSERT_TRUE(verify(surface, good).ok());
  for (std::size_t block = 0; block < good.blocks.size(); ++block)
    for (std::size_t lane = 0; lane < runtime::kBlockWidth; ++lane) {
      if (good.blocks[block].radius[lane] < 0) continue;
      PackedSphereTree tree = good;
      tree.blocks[block].radius[lane] -= static_cast<float>(1e-4 * good.bounding_radius);
      EXPECT_GT(verify(surface, tree).triangles_uncovered, 0u) << block << " " << lane;
    }
}

// A smaller or shifted ball may still do; then sampling must find nothing either.
TEST(Verify, AcceptsAChangedChildOnlyWhereNothingIsLost) {
  int rejected = 0, accepted = 0;
  for (const TriangleMesh& mesh : {l_shape(), torus(24, 12)}) {
    const Surface surface(mesh);
    const PackedSphereTree good = lean_tree(surface);
    const double step = 1e-4 * good.bounding_radius;
    Random random(1, 21);
    for_each_child(good, [&](std::size_t block, std::size_t lane) {
      for (int kind = 0; kind < 3; ++kind) {
        PackedSphereTree tree = good;
        const Vector v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        float& radius = tree.blocks[block].radius[lane];
        if (kind == 0) radius -= static_cast<float>(step);
        if (kind == 1) radius *= 1 - 1e-4f;
        if (kind == 2) move_center(tree, block, lane, step * v.normalized());
        const bool ok = verify(surface, tree).ok();
        ++(ok ? accepted : rejected);
        EXPECT_TRUE(!ok || samples_find_nothing(surface, tree)) << block << " " << lane << " " << kind;
      }
    });
  }
  RecordProperty("rejected", rejected);
  RecordProperty("accepted", accepted);
  EXPECT_GT(rejected, 20);
  EXPECT_GT(accepted, 20);
}

TEST(Verify, RejectsALeafWhoseTrianglesAreDropped) {
  const Surface surface(l_shape());
  const PackedSphereTree good = lean_tree(surface);
  for_each_child(good, [&](std::size_t block, std::size_t lane) {
    const std::uint32_t link = good.blocks[block].link[lane];
    if ((link & runtime::kLeafBit) == 0) return;
    PackedSphereTree tree = good;
    tree.blocks[block].link[lane] = runtime::kEmptyLeaf;
    const Verification result = verify(surface, tree);
    EXPECT_GT(result.triangles_unlisted, 0u) << block << " " << lane;
    EXPECT_EQ(result.triangles_uncovered, 0u);
    // One triangle at a time: some of them must be missed.
    std::vector<std::uint32_t> list;
    for (const std::uint32_t triangle : runtime::listed_triangles(good, link))
      list.push_back(triangle & ~runtime::kLeafBit);
    bool missed = false;
    for (std::size_t k = 0; k < list.size() && !missed; ++k) {
      tree = good;
      auto shorter = list;
      shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(k));
      tree.blocks[block].link[lane] = runtime::add_list(tree, shorter);
      missed = !verify(surface, tree).ok();
    }
    EXPECT_TRUE(missed) << block << " " << lane;
  });
}

TEST(Verify, RejectsEveryBoundThatIsLowered) {
  const Surface surface(l_shape());
  const PackedSphereTree good = lean_tree(surface);
  const double R = good.bounding_radius;
  for_each_child(good, [&](std::size_t block, std::size_t lane) {
    PackedSphereTree tree = good;
    tree.blocks[block].depth[lane] -= static_cast<float>(1e-4 * R);
    EXPECT_GT(verify(surface, tree).bounds_violated, 0u);
    // Bounds over the ball are stored with up to 1.25 % to spare.
    const Point center = center_of(good, block, lane);
    const double truth = farthest_from_solid(surface, {center, good.blocks[block].radius[lane]}, {1e-6, 0}).lower;
    if (truth < 1e-3 * R) return;
    tree = good;
    tree.blocks[block].error[lane] = static_cast<float>(truth * (1 - 1e-4));
    const Verification result = verify(surface, tree);
    ASSERT_EQ(result.bounds_violated, 1u);
    EXPECT_EQ(result.violations[0].kind, Violation::Kind::distance_bound);
    EXPECT_GT(surface.signed_distance(result.violations[0].point), tree.blocks[block].error[lane]);
  });
}

TEST(Verify, CallsSpheresThatJustMeetTangent) {
  // Two balls that meet in the plane between the halves of a box, to the last digit and a little apart.
  const Surface surface(box(Point(-2, -1, -1), Point(2, 1, 1)));
  const double radius = std::sqrt(3.0);
  const auto tree = [&](double gap) {
    const Point left(-1, 0, 0), right(1, 0, 0);
    return std::vector<PathBall>{
        {Point::Zero(), 3, kNone, false}, {left, radius - gap, 0, true}, {right, radius - gap, 0, true}};
  };
  EXPECT_TRUE(verify_path_rule(surface, tree(-1e-6)).ok());
  for (const double gap : {0.0, 1e-9}) {
    const Verification result = verify_path_rule(surface, tree(gap));
    EXPECT_FALSE(result.ok());
    EXPECT_TRUE(result.only_tangent(surface.bounding_radius())) << gap;
    EXPECT_EQ(result.uncovered_nodes, (std::vector<Index>{1, 2}));
  }
  EXPECT_FALSE(verify_path_rule(surface, tree(1e-3)).only_tangent(surface.bounding_radius()));
}

TEST(Verify, NamesAPointThatHasNoPathAndHowDeepItLies) {
  const Surface surface(torus(24, 12));
  PackedSphereTree tree = packed_tree(surface);
  for (std::size_t b = 1; b < tree.blocks.size(); ++b)
    for (float& r : tree.blocks[b].radius) r *= r > 0 ? 0.9f : 1.0f;
  const Verification result = verify(surface, tree);
  ASSERT_FALSE(result.ok());
  EXPECT_GT(result.uncovered.distance.lower, 0);
  EXPECT_GT(result.uncovered.area.lower, 0);
  EXPECT_FALSE(result.only_tangent(surface.bounding_radius()));
  for (const Violation& violation : result.violations) {
    ASSERT_EQ(violation.kind, Violation::Kind::uncovered);
    EXPECT_LT(surface.distance(violation.point), 1e-9);
  }
}

TEST(Verify, ListsNoMoreViolationsThanAskedForButCountsAll) {
  const Surface surface(torus(24, 12));
  PackedSphereTree tree = packed_tree(surface);
  for (std::size_t b = 1; b < tree.blocks.size(); ++b)
    for (float& r : tree.blocks[b].radius) r *= r > 0 ? 0.5f : 1.0f;
  const Verification result = verify(surface, tree, {.max_violations = 3});
  EXPECT_EQ(result.violations.size(), 3u);
  EXPECT_GT(result.triangles_uncovered, 3u);
}

TEST(Verify, IsTheSameOnOneTwoAndSevenThreads) {
  const Surface surface(torus(24, 12));
  PackedSphereTree tree = packed_tree(surface);
  for (auto& block : tree.blocks) block.radius[1] *= 0.7f;
  std::vector<Verification> results;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(verify(surface, tree));
  }
  for (const Verification& other : results) {
    ASSERT_EQ(other.violations.size(), results[0].violations.size());
    EXPECT_EQ(other.uncovered.distance.lower, results[0].uncovered.distance.lower);
    EXPECT_EQ(other.uncovered.area.upper, results[0].uncovered.area.upper);
    EXPECT_EQ(other.uncovered_nodes, results[0].uncovered_nodes);
    for (std::size_t i = 0; i < other.violations.size(); ++i) {
      EXPECT_EQ(other.violations[i].triangle, results[0].violations[i].triangle);
      EXPECT_EQ(other.violations[i].point, results[0].violations[i].point);
    }
  }
}

}  // namespace
}  // namespace orchard
