#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

std::vector<Point> points_of(const std::string& xyz) {
  std::istringstream text(xyz);
  std::vector<Point> points;
  for (Point p; text >> p.x() >> p.y() >> p.z();) points.push_back(p);
  return points;
}

TEST(Sample, WritesPointsOfTheSurface) {
  const Workplace here;
  const TriangleMesh mesh = test::l_shape();
  const Finished run = here.run(
      {"sample", here.add("l.obj", mesh), "-o", (here / "out").string(), "--samples", "500", "--json", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  const std::vector<Point> points = points_of(here.files("out").at("l.xyz"));
  EXPECT_EQ(points.size(), report["points"].get<std::size_t>());
  EXPECT_NEAR(static_cast<double>(points.size()), 500, 25);
  const Surface surface(mesh);
  for (const Point& point : points) EXPECT_LT(surface.distance(point), 1e-12);
}

// A ring of twelve sides, whose edges turn by 30 degrees but for rounding, is where two opinions of an edge would show.
TEST(Sample, SpreadsThePointsOfTheLibrarysStandards) {
  const Workplace here;
  const TriangleMesh mesh = test::torus(24, 12);
  const Finished run = here.run({"sample", here.add("ring.obj", mesh), "-o", (here / "out").string(), "--samples",
                                 "500", "--relaxation", "neighbors", "--quiet", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<Point> points = points_of(here.files("out").at("ring.xyz"));
  const SurfaceSampling wanted =
      sample_surface(Surface(mesh), {.face_points = 400, .edge_points = 100, .relaxation = Relaxation::neighbors});
  ASSERT_EQ(points.size(), wanted.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - wanted.points[i]).norm(), 1e-12) << i;
}

TEST(Sample, SpreadsPointsMoreEvenlyByRelaxing) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(3));
  for (const char* relaxation : {"automatic", "neighbors"}) {
    const Finished run = here.run({"sample", mesh, "-o", (here / "out").string(), "--samples", "2000", "--edge-samples",
                                   "0", "--relaxation", relaxation, "--json", "--no-views"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json evenness = json::parse(run.out)["evenness"];
    EXPECT_LT(evenness["after"]["deviation_over_mean"].get<double>(),
              0.5 * evenness["before"]["deviation_over_mean"].get<double>());
    EXPECT_GT(evenness["after"]["mean_distance"].get<double>(), evenness["before"]["mean_distance"].get<double>());
  }
}

TEST(Sample, TakesAnyTrianglesAndRepairsWhatItCan) {
  const Workplace here;
  for (const auto& [name, mesh] :
       {std::pair{"open.obj", test::open_box()}, {"turned.obj", test::mirrored(test::l_shape())}}) {
    const Finished run = here.run({"sample", here.add(name, mesh), "-o", (here / "out").string(), "--samples", "200"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out.find("turned 1 part") != std::string::npos, name == std::string("turned.obj")) << run.out;
  }
}

TEST(Sample, WritesTheSameBytesForASeedOnAnyNumberOfThreads) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(20, 10));
  const auto points = [&](const std::string& seed, const std::string& threads) {
    const Finished run = here.run({"sample", mesh, "-o", (here / "out").string(), "--samples", "400", "--quiet",
                                   "--seed", seed, "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out + run.err, "");
    return here.files("out").at("torus.xyz");
  };
  const std::string first = points("1", "1");
  EXPECT_EQ(first, points("1", "3"));
  EXPECT_NE(first, points("2", "1"));
}

TEST(Sample, RefusesBadInputInOneLine) {
  const Workplace here;
  const Finished run = here.run({"sample", (here / "missing.obj").string(), "-o", (here / "out").string()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  EXPECT_TRUE(here.files("out").empty());
  const std::string mesh = here.add("l.obj", test::l_shape());
  EXPECT_EQ(here.run({"sample", mesh, "-o", (here / "out").string(), "--relaxation", "none"}).exit_code, 2);
}

}  // namespace
}  // namespace orchard
