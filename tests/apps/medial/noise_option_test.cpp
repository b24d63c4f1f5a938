// `orchard medial --noise`.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "orchard/geometry/random.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// A torus whose vertices are off by up to `amplitude` (of the diagonal) in every direction.
TriangleMesh rough_torus(double amplitude) {
  TriangleMesh mesh = test::torus(64, 32);
  Box box;
  for (const Point& vertex : mesh.vertices) box.extend(vertex);
  Random random(3, 1);
  const auto part = [&] { return amplitude * box.diagonal().norm() * random.uniform(-1, 1); };
  for (Point& vertex : mesh.vertices) {
    const double x = part(), y = part(), z = part();
    vertex += Vector(x, y, z);
  }
  return mesh;
}

json medial_report(const Workplace& here, const std::string& mesh, const std::vector<std::string>& more) {
  std::vector<std::string> words{"medial",    mesh,     "-o",         (here / "out").string(),
                                 "--samples", "1500",   "--no-views", "--accept",
                                 "--json",    "--force"};
  words.insert(words.end(), more.begin(), more.end());
  const Finished run = here.run(words);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return json::parse(run.out);
}

TEST(NoiseOption, GivesTheAxisOfTheSurfaceBelowTheNoise) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", rough_torus(0.003));
  const json report = medial_report(here, mesh, {"--noise", "auto"});
  const json& noise = report["noise"];
  EXPECT_TRUE(noise["estimated"].get<bool>());
  EXPECT_NEAR(noise["deviation_over_diagonal"].get<double>(), 0.003 / std::sqrt(3), 0.0006);
  EXPECT_GT(noise["rounds"].get<int>(), 0);
  EXPECT_EQ(report["topology"], report["topology_of_solid"]);
  const auto balls = [](const json& of) { return of["build"]["vertices"].get<int>(); };
  EXPECT_LT(2 * balls(report), balls(medial_report(here, mesh, {})));
  EXPECT_EQ(here.files("out").count("torus-smoothed.obj"), 1u);
}

TEST(NoiseOption, LeavesACleanMeshAsItIs) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(64, 32));
  const json report = medial_report(here, mesh, {"--noise", "auto"});
  EXPECT_EQ(report["noise"]["rounds"], 0);
  EXPECT_EQ(here.files("out").count("torus-smoothed.obj"), 0u);
}

TEST(NoiseOption, RefusesWhatIsNoLevelAndWhatItHasNoPartIn) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(16, 8));
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--noise", "much"},
                                                                                    {"--noise", "-1"},
                                                                                    {"--noise", "6"},
                                                                                    {"--noise", "nan"},
                                                                                    {"--noise", "auto", "--wrap"},
                                                                                    {"--noise", "auto", "--strict"}}) {
    std::vector<std::string> words{"medial", mesh, "-o", (here / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(here.run(words).exit_code, 2) << more[1];
  }
}

}  // namespace
}  // namespace orchard
