#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bodies.h"
#include "orchard/runtime/narrow_phase.h"
#include "support/query_of_trees.h"

// The narrow phase against brute force.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

using Placed = std::vector<Triangle>;

bool inside(const std::array<long double, 3>& p, const Placed& solid) {
  long double angle = 0;
  for (const Triangle& t : solid) {
    std::array<std::array<long double, 3>, 3> v{};
    std::array<long double, 3> length{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) v[i][k] = t[i][k] - p[k];
      length[i] = std::sqrt(v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2]);
    }
    const auto dot = [&v](std::size_t i, std::size_t j) {
      return v[i][0] * v[j][0] + v[i][1] * v[j][1] + v[i][2] * v[j][2];
    };
    const long double volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                               v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                               v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    angle += 2 * std::atan2(volume, length[0] * length[1] * length[2] + dot(0, 1) * length[2] + dot(1, 2) * length[0] +
                                        dot(2, 0) * length[1]);
  }
  return angle > 2 * std::numbers::pi_v<long double>;
}

struct Truth {
  bool touch;
  double surface_gap, solid_gap;
};

Truth truth_of(const Body& a, const Body& b, const Pose& pose_a, const Pose& pose_b) {
  const Placed pa = placed_triangles(a.tree, pose_a), pb = placed_triangles(b.tree, pose_b);
  if (surfaces_intersect(pa, pb)) return {true, 0, 0};
  const double gap = static_cast<double>(surface_distance(pa, pb));
  const bool nested = (a.closed && inside(pb[0][0], pa)) || (b.closed && inside(pa[0][0], pb));
  return {false, gap, nested ? 0 : gap};
}

// Everything that must hold at every moment of a query, level by level.
void check_query(const Body& a, const Body& b, const Pose& pose_a, const Pose& pose_b, const Truth& truth) {
  test::OwnNarrowPhase query(a.tree, b.tree);
  const double tolerance = 1e-12 * (1 + std::fabs(pose_a.translation[0]));
  double bound = std::numeric_limits<double>::infinity();
  Answer answer = query.start(pose_a, pose_b);
  for (std::uint32_t level = 0;; ++level) {
    ASSERT_EQ(query.progress().level, level);
    ASSERT_NE(answer, truth.touch ? Answer::no : Answer::yes) << "at level " << level;
    ASSERT_GE(query.separation_bound(), truth.solid_gap - tolerance);
    ASSERT_LE(query.separation_bound(), bound);
    ASSERT_GE(query.lower_bound(), 0);
    ASSERT_LE(query.lower_bound(), truth.surface_gap + tolerance);
    ASSERT_TRUE(query.progress().pairs > 0 || query.finished());
    bound = query.separation_bound();
    if (query.finished()) break;
    ASSERT_EQ(answer, Answer::maybe);
    answer = query.refine();
  }
  ASSERT_EQ(answer, truth.touch ? Answer::yes : Answer::no);
  ASSERT_TRUE(query.lower_bound() == 0 || answer == Answer::no);
  if (answer == Answer::yes) {
    ASSERT_EQ(query.separation_bound(), 0);
    const Contact contact = query.contact();
    const Triangle ta = placed_triangles(a.tree, pose_a).at(contact.triangle_a);
    const Triangle tb = placed_triangles(b.tree, pose_b).at(contact.triangle_b);
    ASSERT_LE(triangle_distance(ta, tb), 1e-12 * (1 + std::fabs(pose_a.translation[0])));
    const std::array<long double, 3> center = {contact.center[0], contact.center[1], contact.center[2]};
    ASSERT_LE(point_distance(center, ta), 1e-8);
    ASSERT_LE(point_distance(center, tb), 1e-8);
  }
  test::OwnNarrowPhase direct(a.tree, b.tree);
  direct.start(pose_a, pose_b);
  ASSERT_EQ(direct.refine_exactly(), answer);
  ASSERT_TRUE(direct.finished());
  ASSERT_GE(direct.separation_bound(), truth.solid_gap - tolerance);
  ASSERT_LE(direct.progress().level, 1u);
  const std::uint32_t deepest = std::max(a.tree.depth, b.tree.depth);
  ASSERT_LE(query.progress().level, deepest + 1);
  ASSERT_EQ(query.refine(), answer);  // nothing happens any more
}

TEST(NarrowPhase, AgreesWithBruteForceAtRandomPoses) {
  const auto all = bodies();
  int touching = 0, apart = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Body &a = all[draw.bits() % all.size()], &b = all[draw.bits() % all.size()];
    SCOPED_TRACE(a.name + " / " + b.name);
    const double reach = a.tree.bounding_radius + b.tree.bounding_radius;
    const Pose pose_a = centered(a.tree, draw.pose(5));
    Pose pose_b = draw.pose(draw.uniform(0, 1.1 * reach));
    const Vec to = transform(pose_a, {a.tree.origin[0], a.tree.origin[1], a.tree.origin[2]});
    pose_b = centered(b.tree, pose_b);
    for (std::size_t i = 0; i < 3; ++i) pose_b.translation[i] += to[i];
    const Truth truth = truth_of(a, b, pose_a, pose_b);
    (truth.touch ? touching : apart) += 1;
    check_query(a, b, pose_a, pose_b, truth);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(touching, 300);
  EXPECT_GT(apart, 300);
}

// Approaches until the surfaces just touch, then steps back and forth by less and less.
TEST(NarrowPhase, AgreesWithBruteForceAroundTheFirstContact) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Body &a = all[draw.bits() % all.size()], &b = all[draw.bits() % all.size()];
    SCOPED_TRACE(a.name + " / " + b.name);
    const double reach = a.tree.bounding_radius + b.tree.bounding_radius;
    const Pose pose_a = centered(a.tree, draw.pose(0));
    const Pose turned = centered(b.tree, draw.pose(0));
    const Vec way = draw.direction();
    const auto at = [&](double distance) {
      Pose pose = turned;
      for (std::size_t i = 0; i < 3; ++i) pose.translation[i] += distance * way[i];
      return pose;
    };
    const Placed pa = placed_triangles(a.tree, pose_a);
    double far = 1.01 * reach, near = far;
    while (near > 0 && !surfaces_intersect(pa, placed_triangles(b.tree, at(near)))) far = near, near -= 0.02 * reach;
    if (near <= 0) continue;
    while (far - near > 1e-13 * reach) {
      const double middle = (near + far) / 2;
      (surfaces_intersect(pa, placed_triangles(b.tree, at(middle))) ? near : far) = middle;
    }
    for (const double step : {-1e-2, -1e-4, -1e-6, -1e-8, -1e-10, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
      SCOPED_TRACE(step);
      const Pose pose_b = at(near + step * reach);
      check_query(a, b, pose_a, pose_b, truth_of(a, b, pose_a, pose_b));
      if (HasFatalFailure()) return;
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
