#include "certificate/certificate.h"

#include <gtest/gtest.h>

#include "algorithms/build.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/inagaki.h"
#include "predicates/frame.h"
#include "voronoi/algorithms/shaken_sets.h"
#include "voronoi/diagram/diagram_judge.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard::detail {
namespace {

// Of a finished diagram, as if insert_points() had made all of it.
Certificate certificate_of(const VoronoiDiagram& diagram, bool exact) {
  const Box box = checked_box(diagram.points);
  const Frame frame(box);
  Workspace workspace;
  set_scale(workspace, frame, box);
  for (const Point& p : diagram.points) workspace.points.push_back(frame.inward(p));
  workspace.adopt(diagram.vertices, frame, 0);
  workspace.set_exact(exact);
  if (exact) workspace.forget_noise();
  return certify(workspace, count_forming(workspace));
}

TEST(Certificate, HoldsForExactDiagramsWithNoDepthAtAll) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    const VoronoiDiagram diagram = exact_voronoi(points).diagram;
    const Certificate certificate = certificate_of(diagram, true);
    EXPECT_TRUE(certificate.holds) << name;
    EXPECT_EQ(certificate.intrusion, 0) << name;
  }
}

TEST(Certificate, IsReportedAndHoldsTheDepthThatTheJudgeFinds) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    const auto [diagram, report] = highest_first_voronoi(points);
    const test::Judgement judgement = test::judge(diagram);
    // Spheres and planes are rounded, in the judge as well.
    EXPECT_LE(judgement.deepest, report.certified_intrusion + 1e-11) << name;
    EXPECT_LE(judgement.beyond, report.certified_intrusion + 1e-11) << name;
    EXPECT_LE(report.certified_intrusion, tolerance::kVoronoiIntrusion) << name;
  }
}

// Inagaki's diagrams are right, a little wrong or very wrong, by chance: just what a certificate has to tell apart.
TEST(Certificate, IsNeverGivenToADiagramThatIsWrong) {
  int given = 0, refused = 0, wrong = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const test::ShakenSet set = test::shaken_set(seed);
    const VoronoiDiagram diagram = inagaki_voronoi(set.points).diagram;
    if (diagram.vertices.empty()) continue;
    const test::Judgement judgement = test::judge(diagram);
    const bool is_wrong =
        judgement.deepest > tolerance::kVoronoiIntrusion || judgement.beyond > tolerance::kVoronoiIntrusion;
    const bool holds = certificate_of(diagram, false).holds;
    wrong += is_wrong;
    ++(holds ? given : refused);
    EXPECT_FALSE(holds && is_wrong) << set.name << ": " << judgement.deepest << " deep, " << judgement.beyond
                                    << " beyond";
    EXPECT_FALSE(is_wrong && certificate_of(diagram, true).holds) << set.name;
  }
  EXPECT_GT(given, 20) << "the sets are too hard to tell anything";
  EXPECT_GT(wrong, 20) << "the sets are too easy to tell anything";
  EXPECT_LT(refused, given + 2 * wrong) << "right diagrams are refused";
}

TEST(Certificate, IsRefusedWhereAPointHasMovedAway) {
  int moved = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    VoronoiDiagram diagram = exact_voronoi(test::uniform_points(40, seed)).diagram;
    ASSERT_TRUE(certificate_of(diagram, false).holds);
    Point& p = diagram.points[seed];
    p += 0.5 * (diagram.points[(seed + 7) % 40] - p);
    const test::Judgement judgement = test::judge(diagram);
    if (judgement.deepest <= tolerance::kVoronoiIntrusion && judgement.beyond <= tolerance::kVoronoiIntrusion) continue;
    ++moved;
    for (const bool exact : {false, true}) EXPECT_FALSE(certificate_of(diagram, exact).holds) << seed;
  }
  EXPECT_GT(moved, 10);
}

}  // namespace
}  // namespace orchard::detail
