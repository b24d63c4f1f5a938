#include "gaps/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

Box unit_box() { return {Point::Zero(), Point::Ones()}; }

// Points as gap repair adds them, and as it might: on two sheets, along a line in order, crowding into a corner, all
// at one place, and beyond the bounds.
std::vector<std::vector<Point>> arrivals(Index count) {
  std::vector<std::vector<Point>> all(5);
  for (Index i = 0; i < count; ++i) {
    Random random(11, 3, i);
    const double x = random.uniform(), y = random.uniform(), t = (i + 0.5) / count;
    all[0].push_back({x, y, i % 2 == 0 ? 0.5 : 0.501});
    all[1].push_back({t, t, 0.25});
    all[2].push_back(std::exp2(-40 * random.uniform()) * Point(x, y, 1));
    all[3].push_back({0.3, 0.3, 0.3});
    all[4].push_back({3 * x - 1, 3 * y - 1, 0.5});
  }
  return all;
}

TEST(PointTree, FindsWhatLookingAtEveryPointFinds) {
  for (const std::vector<Point>& points : arrivals(400)) {
    PointTree tree(unit_box());
    for (Index i = 0; i < points.size(); ++i) {
      for (int k = 0; k < 8; ++k) {
        Random random(12, i, static_cast<std::uint64_t>(k));
        // Anywhere; or as far from one of the points as that point's distance exactly.
        Point query(random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5), random.uniform());
        if (k >= 4) query = points[random.below(points.size())] + std::exp2(-random.uniform(0, 30)) * Vector::UnitZ();
        double distance = std::exp2(-random.uniform(0, 20));
        if (k % 2 == 0) distance = (points[random.below(points.size())] - query).norm();
        const auto nearer = [&](const Point& p) { return (p - query).squaredNorm() < distance * distance; };
        const auto not_farther = [&](const Point& p) { return !((p - query).norm() > distance); };
        const auto end = points.begin() + i;
        EXPECT_EQ(tree.any_within(query, distance, nearer), std::any_of(points.begin(), end, nearer));
        EXPECT_EQ(tree.any_within(query, distance, not_farther), std::any_of(points.begin(), end, not_farther));
      }
      tree.add(points[i]);
    }
  }
}

// Each point is asked about before it comes, as in gap repair, within less than what keeps it apart from most others:
// what fraction of its distance to the origin. No search ends early.
double steps_for_each(const std::vector<Point>& points, double fraction) {
  PointTree tree(unit_box());
  for (const Point& point : points) {
    tree.any_within(point, fraction * point.norm(), [](const Point&) { return false; });
    tree.add(point);
  }
  return static_cast<double>(tree.steps()) / static_cast<double>(points.size());
}

TEST(PointTree, LooksAtFewPointsInWhateverOrderTheyCome) {
  constexpr Index kCount = 2000;
  const auto few = arrivals(kCount), many = arrivals(16 * kCount);
  for (const std::size_t kind : {0u, 1u, 2u}) {
    SCOPED_TRACE(kind);
    const double apart = kind == 1 ? 1.0 / kCount : 1 / std::sqrt(kCount);
    const double before = steps_for_each(few[kind], 0.2 * apart);
    const double after = steps_for_each(many[kind], 0.2 * apart / (kind == 1 ? 16 : 4));
    EXPECT_LT(before, 200);
    EXPECT_LT(after, 2 * before) << "a logarithm grows by a third, looking at all of them 16-fold";
  }
}

}  // namespace
}  // namespace orchard::detail
