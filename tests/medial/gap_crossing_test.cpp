// More than 300 lines: one expectation of what repair has to achieve serves the tests of every way in which points can
// leave gaps, and of every option that mends them.
#include "orchard/medial/gap_crossing.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>

#include "gaps/crossings.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/quality.h"
#include "outlines.h"
#include "support.h"
#include "support/shapes.h"

namespace orchard {
namespace {

GapRepair sampled_and_repaired(const Surface& surface, const SamplingOptions& sampling,
                               const GapRepairOptions& options = {}) {
  SurfaceSampling points = sample_surface(surface, sampling);
  VoronoiDiagram diagram = highest_first_voronoi(points.points).diagram;
  return repair_gap_crossings(surface, std::move(points), std::move(diagram), options);
}

// What every repair has to achieve: no crossing left, and an axis inside the solid with its components and its holes.
void expect_mended(const Surface& surface, const GapRepair& repaired) {
  validate(repaired.sampling, surface);
  validate(repaired.diagram);
  EXPECT_EQ(repaired.report.faces_still_crossing, 0u);
  EXPECT_EQ(repaired.sampling.points.size(), repaired.diagram.points.size());
  const MedialAxis axis = medial_axis(surface, repaired.sampling, repaired.diagram);
  validate(axis, surface);
  EXPECT_EQ(test::count_components(axis), surface.report().components);
  EXPECT_LT(test::farthest_outside(surface, axis), 1e-6);
  EXPECT_EQ(2 * test::euler_characteristic(surface, repaired.diagram), surface.report().euler_characteristic);
}

struct GapCase {
  std::string name;
  TriangleMesh mesh;
  SamplingOptions sampling;
  double max_added;  // fraction of the points
};

std::ostream& operator<<(std::ostream& out, const GapCase& c) { return out << c.name; }

class GapCrossing : public testing::TestWithParam<GapCase> {};

TEST_P(GapCrossing, IsMendedWithFewPoints) {
  const GapCase& c = GetParam();
  const Surface surface(c.mesh);
  ASSERT_TRUE(surface.solid()) << surface.report().faults();
  const GapRepair repaired = sampled_and_repaired(surface, c.sampling);
  EXPECT_GT(repaired.report.passes.front().faces_crossing, 0u) << "the case shows no fault to mend";
  EXPECT_GT(repaired.report.points_added, 0u);
  EXPECT_LT(repaired.report.points_added, c.max_added * (repaired.sampling.size() - repaired.report.points_added));
  expect_mended(surface, repaired);
}

SamplingOptions points(Index face, Index edge) { return {.face_points = face, .edge_points = edge}; }

std::vector<GapCase> gap_cases() {
  using namespace test;
  return {
      {"Fig_6_14_ThinBridge", extruded(thin_bridge(0.06), 1), points(700, 250), 0.5},
      {"Fig_6_14_VeryThinBridge", extruded(thin_bridge(0.004), 1), points(700, 250), 0.5},
      {"Fig_6_15_Knees", extruded(knees(0.02), 1), points(700, 150), 0.25},
      {"Fig_6_18_ShortShelf", extruded(short_shelf(0.05), 1), points(500, 150), 0.25},
      {"Fig_6_19_TwoTeeth", extruded(two_teeth(0.04), 1), points(1000, 200), 0.25},
      {"Fig_6_21_VGroove", extruded(v_groove(0.15), 1), points(700, 150), 0.25},
      {"Fig_6_22_UGroove", extruded(u_groove(0.05), 1), points(700, 150), 0.25},
      {"UShape", u_shape(0.02), points(800, 200), 0.3},
      {"TwoBoxes", two_boxes(0.01), points(600, 200), 0.5},
      {"TwoBoxesHairApart", two_boxes(1e-4), points(600, 200), 0.5},
      {"FarFromTheOrigin", transformed(u_shape(0.02), 1, {1e6, -1e6, 1e6}), points(800, 200), 0.3},
      {"Tiny", transformed(u_shape(0.02), 1e-6, {0, 0, 0}), points(800, 200), 0.3},
  };
}

INSTANTIATE_TEST_SUITE_P(Figures, GapCrossing, testing::ValuesIn(gap_cases()),
                         [](const auto& named) { return named.param.name; });

TEST(GapRepair, AddsNothingToSolidsThatNeedNothing) {
  for (TriangleMesh mesh : {test::box({0, 0, 0}, {1, 2, 3}), test::icosphere(3), test::torus(48, 24)}) {
    const Surface surface(std::move(mesh));
    const GapRepair repaired = sampled_and_repaired(surface, points(800, 200));
    EXPECT_EQ(repaired.report.points_added, 0u);
    EXPECT_EQ(repaired.report.passes.size(), 1u);
    expect_mended(surface, repaired);
  }
}

TEST(GapRepair, FollowsAWireThinnerThanTheSpacing) {
  TriangleMesh mesh = test::box({0, 0, 0}, {10, 0.02, 0.02});
  const Surface surface(std::move(mesh));
  const GapRepair repaired = sampled_and_repaired(surface, points(60, 0));
  Index at_necks = 0;
  for (const GapRepairPass& pass : repaired.report.passes) at_necks += pass.added_at_necks;
  EXPECT_GT(at_necks, 0u);
  expect_mended(surface, repaired);
}

TEST(GapRepair, FindsTheHoleOfAThinRing) {
  const Surface surface(test::torus(48, 12, 1, 0.03));
  const GapRepair repaired = sampled_and_repaired(surface, points(60, 0));
  EXPECT_GT(repaired.report.points_added, 0u);
  EXPECT_EQ(surface.report().euler_characteristic, 0);
  expect_mended(surface, repaired);
}

TEST(GapRepair, FindsAComponentThatNoPointLiesOn) {
  const Surface surface(
      test::joined({test::box({0, 0, 0}, {1, 1, 1}), test::box({1.5, 0.5, 0.5}, {1.52, 0.52, 0.52})}));
  SurfaceSampling sampling = sample_surface(surface, points(500, 100)), kept;
  for (Index i = 0; i < sampling.size(); ++i) {
    if (sampling.points[i].x() > 1.2) continue;
    kept.points.push_back(sampling.points[i]);
    kept.triangles.push_back(sampling.triangles[i]);
    kept.features.push_back(sampling.features[i]);
    kept.origins.push_back(sampling.origins[i]);
  }
  VoronoiDiagram diagram = highest_first_voronoi(kept.points).diagram;
  const GapRepair repaired = repair_gap_crossings(surface, std::move(kept), std::move(diagram));
  EXPECT_GE(repaired.report.points_added, 4u);
  expect_mended(surface, repaired);
}

TEST(GapRepair, KeepsTheGivenPointsAndMarksItsOwn) {
  const Surface surface(test::u_shape(0.02));
  const SurfaceSampling before = sample_surface(surface, points(800, 200));
  const GapRepair repaired = repair_gap_crossings(surface, before, highest_first_voronoi(before.points).diagram);
  const SurfaceSampling& after = repaired.sampling;
  ASSERT_EQ(after.size(), before.size() + repaired.report.points_added);
  for (Index i = 0; i < after.size(); ++i) {
    if (i < before.size()) {
      EXPECT_EQ(after.points[i], before.points[i]);
      EXPECT_EQ(after.origins[i], before.origins[i]);
    } else {
      EXPECT_EQ(after.origins[i], PointOrigin::repair);
    }
    EXPECT_EQ(after.points[i], repaired.diagram.points[i]);
  }
  EXPECT_LT(inaccuracy(repaired.diagram).max, 1e-9) << "of points inserted one pass after another";
}

TEST(GapRepair, ReportsWhatItDidInEachPass) {
  const Surface surface(test::u_shape(0.02));
  const GapRepair repaired = sampled_and_repaired(surface, points(800, 200));
  Index added = 0;
  for (const GapRepairPass& pass : repaired.report.passes) {
    EXPECT_LE(pass.faces_crossing, pass.faces_tested);
    EXPECT_LE(pass.cells_tested, repaired.sampling.size());
    EXPECT_EQ(pass.cells_crossing > 0, pass.faces_crossing > 0);
    added += pass.added_by_projection + pass.added_by_snapping + pass.added_at_necks;
  }
  EXPECT_EQ(added, repaired.report.points_added);
  EXPECT_EQ(repaired.report.passes.back().faces_crossing, 0u);
}

TEST(GapRepair, StopsAfterTheGivenPassesAndCountsWhatIsLeft) {
  const Surface surface(test::u_shape(0.02));
  const GapRepair untouched = sampled_and_repaired(surface, points(800, 200), {.max_passes = 0});
  EXPECT_EQ(untouched.report.points_added, 0u);
  EXPECT_GT(untouched.report.faces_still_crossing, 0u);
  const GapRepair once = sampled_and_repaired(surface, points(800, 200), {.max_passes = 1});
  EXPECT_EQ(once.report.passes.size(), 1u);
  EXPECT_LT(once.report.faces_still_crossing, untouched.report.faces_still_crossing);
}

TEST(GapRepair, LeavesNothingUnderTheLooseDefinitionOfTheDissertation) {
  const Surface surface(test::extruded(test::knees(0.01), 1));
  const GapRepair repaired = sampled_and_repaired(surface, points(700, 150), {.definition = GapDefinition::loose});
  EXPECT_GT(repaired.report.points_added, 0u);
  EXPECT_EQ(repaired.report.faces_still_crossing, 0u);
}

TEST(GapRepair, EndsUnderTheStrictDefinitionThoughAVBouncesForEver) {
  const Surface surface(test::extruded(test::knees(0.01), 1));
  const GapRepairOptions strict{.max_passes = 6, .definition = GapDefinition::strict};
  const GapRepair repaired = sampled_and_repaired(surface, points(700, 150), strict);
  EXPECT_LE(repaired.report.passes.size(), 6u);
  EXPECT_LT(repaired.report.faces_still_crossing, repaired.report.passes.front().faces_crossing);
}

TEST(GapRepair, StrictFlagsAllThatLooseFlags) {
  const Surface surface(test::extruded(test::knees(0.01), 1));
  std::vector<Index> crossing;
  for (const GapDefinition definition : {GapDefinition::strict, GapDefinition::loose}) {
    const GapRepair repaired =
        sampled_and_repaired(surface, points(700, 150), {.max_passes = 0, .definition = definition});
    crossing.push_back(repaired.report.faces_still_crossing);
  }
  EXPECT_GE(crossing[0], crossing[1]);
  EXPECT_GT(crossing[1], 0u);
}

TEST(GapRepair, ForgivesSmallValleysWithinTheJoinedRadius) {
  const Surface surface(test::extruded(test::v_groove(0.15), 1));
  Index last = kNone;
  for (const double radius : {0.0, 1.0, 4.0, 1000.0}) {
    const GapRepair repaired = sampled_and_repaired(surface, points(700, 150),
                                                    {.max_passes = 0, .joined_radius = radius, .mend_necks = false});
    EXPECT_LE(repaired.report.faces_still_crossing, last);
    last = repaired.report.faces_still_crossing;
  }
  EXPECT_EQ(last, 0u) << "the solid is connected";
}

TEST(GapRepair, GivesTheSameBytesOnAnyNumberOfThreads) {
  const Surface surface(test::extruded(test::thin_bridge(0.06), 1));
  std::vector<GapRepair> results;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(sampled_and_repaired(surface, points(700, 250)));
  }
  for (std::size_t k = 1; k < results.size(); ++k) {
    EXPECT_EQ(results[k].sampling.points, results[0].sampling.points);
    EXPECT_EQ(results[k].sampling.triangles, results[0].sampling.triangles);
  }
}

TEST(GapRepair, ScalesWithTheSolidByPowersOfTwo) {
  const TriangleMesh mesh = test::extruded(test::knees(0.05), 1);
  const Surface surface(mesh), large(test::transformed(mesh, 8, Vector::Zero()));
  const GapRepair a = sampled_and_repaired(surface, points(500, 100));
  const GapRepair b = sampled_and_repaired(large, points(500, 100));
  ASSERT_EQ(a.sampling.size(), b.sampling.size());
  for (Index i = 0; i < a.sampling.size(); ++i) EXPECT_EQ(8 * a.sampling.points[i], b.sampling.points[i]);
}

// A fan around the middle of each face of a flat disk: many triangles at one vertex, all of one cluster.
TriangleMesh disk(Index corners, double thickness) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, thickness}};
  for (Index k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), thickness});
  }
  for (Index k = 0; k < corners; ++k) {
    const Index a = 2 + 2 * k, b = 2 + 2 * ((k + 1) % corners);
    for (const auto& triangle :
         {std::array{Index{0}, b, a}, {Index{1}, a + 1, b + 1}, {a, b, b + 1}, {a, b + 1, a + 1}})
      mesh.triangles.push_back(triangle);
  }
  return mesh;
}

// Borders around the middle run through all triangles of a fan; none of them is a neck.
TEST(GapRepair, TakesAFanForNoNeck) {
  const Surface surface(disk(400, 1));
  const GapRepair thick = sampled_and_repaired(surface, points(300, 100));
  EXPECT_EQ(thick.report.points_added, 0u);
  expect_mended(surface, thick);
  const Surface flat(disk(400, 0.01));
  const GapRepair thin = sampled_and_repaired(flat, points(300, 100));
  EXPECT_GT(thin.report.points_added, 0u);
  expect_mended(flat, thin);
}

// By looking at all vertices of all triangles of all clusters.
TEST(GapRepair, LooseForgivesClustersThatShareAVertexAndNoOthers) {
  for (const TriangleMesh& mesh : {test::extruded(test::knees(0.01), 1), test::u_shape(0.02), disk(40, 0.02)}) {
    const Surface surface(mesh);
    const SurfaceSampling sampling = sample_surface(surface, points(600, 100));
    const VoronoiDiagram diagram = highest_first_voronoi(sampling.points).diagram;
    const detail::CellNeighbors neighbors(diagram);
    const detail::RestrictedVoronoi restricted(surface, sampling.points, neighbors);
    const auto scope = detail::ComponentScope::everything(surface, sampling);
    const auto crossings =
        detail::find_crossings(surface, sampling, restricted, scope, {.definition = GapDefinition::loose});
    std::vector<std::set<Index>> vertices(surface.clusters().count());  // of each cluster
    for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
      const auto& corners = surface.mesh().triangles[t];
      vertices[surface.clusters().of_triangle[t]].insert(corners.begin(), corners.end());
    }
    std::set<std::array<Index, 2>> wanted, found;  // cell, triangle
    std::vector<Index> around;
    for (const detail::CellComponent& component : detail::find_cell_components(surface, sampling, restricted, scope)) {
      surface.triangles_at(sampling.triangles[component.cell], sampling.features[component.cell], around);
      for (const Index triangle : component.triangles) {
        const std::set<Index>& reached = vertices[surface.clusters().of_triangle[triangle]];
        const bool allowed = std::any_of(around.begin(), around.end(), [&](Index own) {
          const std::set<Index>& mine = vertices[surface.clusters().of_triangle[own]];
          return std::any_of(mine.begin(), mine.end(), [&](Index vertex) { return reached.contains(vertex); });
        });
        const bool has_border = !restricted.piece(triangle, component.cell)->borders.empty();
        if (!allowed && has_border) wanted.insert({component.cell, triangle});
      }
    }
    for (const detail::Crossing& crossing : crossings) {
      for (const Index triangle : crossing.component.triangles) {
        if (restricted.piece(triangle, crossing.component.cell)->borders.empty()) continue;
        found.insert({crossing.component.cell, triangle});
      }
    }
    EXPECT_FALSE(wanted.empty());
    EXPECT_EQ(found, wanted);
  }
}

// Nearly every cell of a plate thinner than its points are apart gets a new point.
TEST(GapRepair, LooksAtFewNewPointsForEachOfAThinPlate) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 2e-4}));
  std::vector<double> steps;  // for each new point
  for (const Index count : {1500u, 6000u}) {
    const GapRepair repaired = sampled_and_repaired(surface, points(count, count / 5));
    EXPECT_GT(2 * repaired.report.points_added, count);
    EXPECT_EQ(repaired.report.faces_still_crossing, 0u);
    std::size_t sum = 0;
    for (const GapRepairPass& pass : repaired.report.passes) sum += pass.steps_among_new_points;
    steps.push_back(static_cast<double>(sum) / repaired.report.points_added);
  }
  EXPECT_GE(steps[0], 1) << "it has to look at something";
  EXPECT_LT(steps[0], 200);
  EXPECT_LT(steps[1], 1.5 * steps[0]) << "a logarithm grows by a fifth, looking at all of them fourfold";
}

TEST(GapRepair, RefusesWhatIsNoSolid) {
  const Surface surface(test::open_box());
  EXPECT_THROW(repair_gap_crossings(surface, {}, {}), InputError);
}

TEST(GapRepair, StopsWhenTheCallerSaysSo) {
  const Surface surface(test::u_shape(0.02));
  SurfaceSampling sampling = sample_surface(surface, points(200, 50));
  VoronoiDiagram diagram = highest_first_voronoi(sampling.points).diagram;
  EXPECT_THROW(repair_gap_crossings(surface, std::move(sampling), std::move(diagram), {},
                                    [](std::string_view, double) { return false; }),
               Cancelled);
}

TEST(GapRepair, MendsTheBundledModels) {
  // The numbers of points are those of Fig. 6.32.
  for (const auto& [name, count] : {std::pair{"faucet", 3285u}, {"lamp", 3482u}, {"ship", 5181u}}) {
    const std::filesystem::path file = std::filesystem::path(ORCHARD_DATA_DIR) / (std::string(name) + ".obj");
    if (!std::filesystem::exists(file)) continue;
    SCOPED_TRACE(name);
    const Surface surface(read_mesh(file));
    const GapRepair repaired = sampled_and_repaired(surface, points(count - count / 5, count / 5));
    EXPECT_LT(4 * repaired.report.points_added, repaired.sampling.size() - repaired.report.points_added);
    expect_mended(surface, repaired);
  }
}

TEST(GapRepair, WithThinningNeedsFarFewerPointsForTheSame) {
  for (const char* name : {"lamp", "ship"}) {
    const Surface surface(read_mesh(std::filesystem::path(ORCHARD_DATA_DIR) / (std::string(name) + ".obj")));
    const SurfaceSampling sampling = sample_surface(surface, points(800, 200));
    const auto repaired = [&](bool thin) {
      return repair_gap_crossings(surface, sampling, highest_first_voronoi(sampling.points).diagram, {.thin = thin});
    };
    const GapRepair doubled = repaired(false), thinned = repaired(true);
    SCOPED_TRACE(name);
    EXPECT_EQ(doubled.report.points_removed, 0u);
    EXPECT_GT(thinned.report.points_removed, 0u);
    EXPECT_EQ(thinned.sampling.size(), sampling.size() + thinned.report.points_added - thinned.report.points_removed);
    EXPECT_LT(4 * (thinned.sampling.size() - sampling.size()), sampling.size());
    EXPECT_GT(4 * (doubled.sampling.size() - sampling.size()), sampling.size());
    expect_mended(surface, thinned);
    // What is left of the sampling's own points comes first, in its order.
    auto next = sampling.points.begin();
    for (Index i = 0; i < sampling.size() - thinned.report.points_removed; ++i) {
      next = std::find(next, sampling.points.end(), thinned.sampling.points[i]);
      ASSERT_NE(next, sampling.points.end());
    }
  }
}

TEST(GapRepair, MendsScansAndMachineParts) {
  for (const char* name : {"clean/spot.obj", "clean/fandisk.obj", "robot/link1.obj", "peer/bunny-1500.obj"}) {
    const std::filesystem::path file = std::filesystem::path(ORCHARD_SHARED_MODELS) / name;
    if (!std::filesystem::exists(file)) continue;
    SCOPED_TRACE(name);
    const Surface surface(read_mesh(file));
    const GapRepair repaired = sampled_and_repaired(surface, points(1000, 200));
    EXPECT_LT(4 * repaired.report.points_added, repaired.sampling.size());
    expect_mended(surface, repaired);
  }
}

}  // namespace
}  // namespace orchard
