// Sets that are inserted by regions, by as many threads as there are; the threshold is lowered, lest that take long.
// ORCHARD_SHAKEN_SETS=FIRST:COUNT in the environment lets the test of shaken sets look at other and at more sets.
#include "insertion/parallel_insertion.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "algorithms/build.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "predicates/frame.h"
#include "support/effort.h"
#include "voronoi/algorithms/shaken_sets.h"
#include "voronoi/diagram/diagram_judge.h"
#include "voronoi/predicates/quadruples.h"
#include "workspace/insertion_order.h"

namespace orchard::detail {
namespace {

// While it lives, sets of so many points are large ones.
class LargeSet {
 public:
  explicit LargeSet(std::size_t points) : before_(large_set()) { use_large_set(points); }
  ~LargeSet() { use_large_set(before_); }
  LargeSet(const LargeSet&) = delete;
  LargeSet& operator=(const LargeSet&) = delete;

 private:
  std::size_t before_;
};

std::vector<std::pair<std::string, test::Points>> sets() {
  auto result = test::degenerate_point_sets();
  result.emplace_back("uniform", test::uniform_points(4000, 1));
  result.emplace_back("bumpy sphere", test::bumpy_sphere_points(4000, 2));
  result.emplace_back("torus", test::torus_points(2000, 3));
  result.emplace_back("sphere", test::sphere_points(1500, 4));
  result.emplace_back("grid", test::grid_points(14));
  result.emplace_back("turned box lattice", test::turned(test::box_lattice_points(18), 5));
  test::Points clusters;
  for (const std::uint64_t c : {0u, 1u, 2u, 3u}) {
    const auto number = static_cast<double>(c);
    for (const Point& p : test::uniform_points(500, 6 + c))
      clusters.push_back(p * std::pow(0.05, number) + Vector(number, c % 2 == 0 ? 0 : 1, number * number));
  }
  result.emplace_back("clusters", clusters);
  return result;
}

bool same_bytes(const VoronoiDiagram& a, const VoronoiDiagram& b) {
  return a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(VoronoiVertex)) == 0;
}

TEST(ParallelInsertion, GivesTheSameBytesOnOneTwoAndFourThreads) {
  const LargeSet large(200);
  for (const auto& [name, points] : sets()) {
    std::vector<VoronoiBuild> builds;
    for (const std::size_t threads : {1u, 2u, 4u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      builds.push_back(highest_first_voronoi(points));
    }
    for (const VoronoiBuild& other : builds) {
      EXPECT_TRUE(same_bytes(other.diagram, builds[0].diagram)) << name;
      EXPECT_EQ(other.report.certified_intrusion, builds[0].report.certified_intrusion) << name;
      EXPECT_EQ(other.report.settled_insertions, builds[0].report.settled_insertions) << name;
      EXPECT_EQ(other.report.exact_insertions, builds[0].report.exact_insertions) << name;
      EXPECT_EQ(other.report.coplanar_centers, builds[0].report.coplanar_centers) << name;
    }
  }
}

TEST(ParallelInsertion, InsertsEveryPointOnceAndIsCertified) {
  const LargeSet large(200);
  for (const auto& [name, points] : sets()) {
    const auto [diagram, report] = highest_first_voronoi(points);
    EXPECT_NO_THROW(validate(diagram)) << name;
    EXPECT_EQ(report.certified_insertions + report.settled_insertions + report.exact_insertions +
                  report.constrained_insertions + report.duplicates.size() + 4,
              points.size())
        << name;
    if (points.size() > 1000) continue;  // the judge holds all points against all spheres
    const test::Judgement judgement = test::judge(diagram);
    EXPECT_LE(judgement.deepest, std::max(report.certified_intrusion, tolerance::kVoronoiIntrusion)) << name;
    EXPECT_LE(judgement.beyond, std::max(report.certified_intrusion, tolerance::kVoronoiIntrusion)) << name;
    EXPECT_EQ(judgement.missing, 0u) << name;
  }
}

TEST(ParallelInsertion, HasExactlyTheFormingPointsOfTheExactDiagram) {
  const LargeSet large(80);
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    const std::size_t n = 50 + 13 * (seed % 40);
    const test::Points points = seed % 3 == 0   ? test::uniform_points(n, seed)
                                : seed % 3 == 1 ? test::bumpy_sphere_points(n, seed)
                                                : test::torus_points(n, seed);
    const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
    ASSERT_NO_THROW(validate(diagram)) << "seed " << seed;
    ASSERT_EQ(test::quadruples(diagram), test::quadruples(exact_voronoi(points).diagram)) << "seed " << seed;
  }
}

TEST(ParallelInsertion, IsRightOnShakenSets) {
  unsigned long long first = 7'000 + test::first_seed(), count = 60 * test::more();
  if (const char* asked = std::getenv("ORCHARD_SHAKEN_SETS")) {
    ASSERT_EQ(std::sscanf(asked, "%llu:%llu", &first, &count), 2) << "ORCHARD_SHAKEN_SETS=FIRST:COUNT";
  }
  const LargeSet large(48);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const test::ShakenSet set = test::shaken_set(seed);
    const VoronoiDiagram diagram = highest_first_voronoi(set.points).diagram;
    if (diagram.vertices.empty()) continue;
    ASSERT_NO_THROW(validate(diagram)) << set.name;
    const test::Judgement judgement = test::judge(diagram);
    EXPECT_LE(judgement.deepest, tolerance::kVoronoiIntrusion) << set.name << ": a point lies in a sphere";
    EXPECT_LE(judgement.beyond, tolerance::kVoronoiIntrusion) << set.name << ": a point lies beyond the hull";
    EXPECT_EQ(judgement.missing, 0u) << set.name;
  }
}

TEST(ParallelInsertion, LeavesFewPointsForOneThread) {
  const LargeSet large(10000);
  for (const test::Points& points : {test::uniform_points(20000, 1), test::bumpy_sphere_points(20000, 1)}) {
    Box box;
    for (const Point& p : points) box.extend(p);
    const Frame frame(box);
    Workspace workspace;
    set_scale(workspace, frame, box);
    for (const Index i : insertion_order(points, box)) workspace.points.push_back(frame.inward(points[i]));
    Inserter inserter(workspace, Search::highest_first, workspace.points.size());
    ASSERT_TRUE(inserter.start({0, 1, 2, 3}));
    for (Index i = 4; i < points.size() / 8; ++i) ASSERT_TRUE(inserter.insert(i));
    std::vector<Index> waiting(points.size() - points.size() / 8);
    std::iota(waiting.begin(), waiting.end(), static_cast<Index>(points.size() / 8));
    insert_in_regions(workspace, inserter, waiting, static_cast<Index>(points.size()), [](std::size_t) {});
    EXPECT_LT(waiting.size(), points.size() / 8);
    EXPECT_TRUE(std::is_sorted(waiting.begin(), waiting.end()));
  }
}

TEST(ParallelInsertion, ReportsProgressFromTheCallingThreadWithoutJumps) {
  const LargeSet large(10000);
  // With more threads the calling one may be the last to get work.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<double> fractions{0};
  highest_first_voronoi(test::uniform_points(20000, 1), [&](std::string_view, double fraction) {
    fractions.push_back(fraction);
    return true;
  });
  EXPECT_EQ(fractions.back(), 1);
  for (std::size_t i = 1; i < fractions.size(); ++i) {
    EXPECT_GE(fractions[i], fractions[i - 1]);
    EXPECT_LE(fractions[i], fractions[i - 1] + 0.05);
  }
}

TEST(ParallelInsertion, StopsWhenItsProgressIsDeclined) {
  const LargeSet large(10000);
  for (const double last : {0.4, 0.7, 0.9})
    EXPECT_THROW(highest_first_voronoi(test::uniform_points(20000, 1),
                                       [&](std::string_view, double fraction) { return fraction < last; }),
                 Cancelled);
}

TEST(ParallelInsertion, ChangesNothingButTheOrderOfTheVertices) {
  const test::Points points = test::uniform_points(2000, 1);
  const VoronoiDiagram small = highest_first_voronoi(points).diagram;
  const LargeSet large(1000);
  const VoronoiDiagram other = highest_first_voronoi(points).diagram;
  EXPECT_EQ(test::quadruples(small), test::quadruples(other));
  EXPECT_FALSE(same_bytes(small, other)) << "else it shows nothing";
}

}  // namespace
}  // namespace orchard::detail
