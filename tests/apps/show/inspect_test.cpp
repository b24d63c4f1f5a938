#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

TEST(Inspect, ReportsWhatAMeshIs) {
  const Workplace here;
  const struct {
    const char* name;
    TriangleMesh mesh;
    int components, euler, loops;
    json genus;
    bool solid, repairable;
  } cases[] = {
      {"torus.obj", test::torus(12, 8), 1, 0, 0, 1, true, true},
      {"boxes.obj", test::two_boxes(1), 2, 4, 0, 0, true, true},
      {"open.obj", test::open_box(), 1, 1, 1, nullptr, false, false},
      {"inside-out.obj", test::mirrored(test::l_shape()), 1, 2, 0, 0, false, true},
  };
  for (const auto& [name, mesh, components, euler, loops, genus, solid, repairable] : cases) {
    const Finished run = here.run({"inspect", here.add(name, mesh), "--json"});
    ASSERT_EQ(run.exit_code, 0) << name << run.err;
    const json report = json::parse(run.out);
    EXPECT_EQ(report["kind"], "mesh");
    EXPECT_EQ(report["vertices"], mesh.vertices.size()) << name;
    EXPECT_EQ(report["triangles"], mesh.triangles.size()) << name;
    EXPECT_EQ(report["components"], components) << name;
    EXPECT_EQ(report["euler_characteristic"], euler) << name;
    EXPECT_EQ(report["boundary_loops"], loops) << name;
    EXPECT_EQ(report["genus"], genus) << name;
    EXPECT_EQ(report["solid"], solid) << name;
    EXPECT_EQ(report["faults"].get<std::string>().empty(), solid) << name;
    EXPECT_EQ(report["repair"]["solid"], repairable) << name;
    EXPECT_EQ(report["self_intersections"], 0) << name;
    for (const char* key :
         {"non_manifold_edges", "non_manifold_vertices", "degenerate_triangles", "duplicate_triangles"})
      EXPECT_EQ(report[key], 0) << name << key;
  }
}

TEST(Inspect, ReportsWhatAnAxisASphereSetAndPointsAre) {
  const Workplace here;
  const std::string axis =
      here.add("plate.ma", "3 3 1\nv 0 0 0 1\nv 4 0 0 1\nv 0 3 0 2\ne 0 1\ne 0 2\ne 1 2\nf 0 1 2\n");
  const json of_axis = json::parse(here.run({"inspect", axis, "--json"}).out);
  EXPECT_EQ(of_axis["kind"], "medial axis");
  EXPECT_EQ(of_axis["balls"], 3);
  EXPECT_EQ(of_axis["parts"]["sheet"], 1);
  EXPECT_NEAR(of_axis["area"].get<double>(), 6, 1e-12);
  EXPECT_NEAR(of_axis["border_length"].get<double>(), 12, 1e-12);
  EXPECT_EQ(of_axis["radii"], json({1.0, 2.0}));
  EXPECT_NEAR(of_axis["diagonal"].get<double>(), std::sqrt(7.0 * 7 + 6.0 * 6 + 4.0 * 4), 1e-12);

  const json of_set =
      json::parse(here.run({"inspect", here.add("set.txt", "0 0 0 1\n2 0 0 -1\n5 0 0 2\n"), "--json"}).out);
  EXPECT_EQ(of_set["kind"], "sphere set");
  EXPECT_EQ(of_set["spheres"], 2);
  EXPECT_EQ(of_set["switched_off"], 1);
  EXPECT_EQ(of_set["radii"], json({1.0, 2.0}));

  const json of_points = json::parse(here.run({"inspect", here.add("points.xyz", "0 0 0\n3 4 0\n"), "--json"}).out);
  EXPECT_EQ(of_points["kind"], "points");
  EXPECT_EQ(of_points["points"], 2);
  EXPECT_NEAR(of_points["diagonal"].get<double>(), 5, 1e-12);
}

TEST(Inspect, NamesTheUnitOfLengthsAreasAndVolumes) {
  const Workplace here;
  const Finished run =
      here.run({"inspect", here.add("box.obj", test::box(Point(0, 0, 0), Point(3, 4, 12))), "--unit", "mm"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find(" 13 mm\n"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(" 144 mm^3\n"), std::string::npos) << run.out;
}

TEST(Inspect, GivesTheSmallestBoundingBallAndTheVolume) {
  const Workplace here;
  const Finished run = here.run({"inspect", here.add("l.obj", test::l_shape()), "--json"});
  const json report = json::parse(run.out), &ball = report["bounding_ball"];
  EXPECT_NEAR(report["volume"].get<double>(), 3, 1e-12);
  EXPECT_NEAR(ball[3].get<double>(), 1.5, 0.05);  // sqrt(2 + 1/4)
}

TEST(Inspect, SaysWhatBuildWouldDo) {
  const Workplace here;
  const Finished open = here.run({"inspect", here.add("open.obj", test::open_box())});
  EXPECT_NE(open.out.find("not a solid: 4 boundary edges"), std::string::npos) << open.out;
  EXPECT_NE(open.out.find("--wrap"), std::string::npos) << open.out;
  const Finished turned = here.run({"inspect", here.add("turned.obj", test::mirrored(test::l_shape()))});
  EXPECT_NE(turned.out.find("repair: turned 1 part outward"), std::string::npos) << turned.out;
  const Finished good = here.run({"inspect", here.add("good.obj", test::l_shape())});
  EXPECT_NE(good.out.find("\na solid:"), std::string::npos) << good.out;
}

TEST(Inspect, ReadsTreesInBothFormats) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(2)), out = (here / "out").string();
  ASSERT_EQ(here.run({"build", mesh, "-o", out, "--method", "octree", "--depth", "2", "--quiet"}).exit_code, 0);
  json levels[2];
  for (int i = 0; i < 2; ++i) {
    const Finished run = here.run({"inspect", out + (i == 0 ? "/ball.orchard" : "/ball.sph"), "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json report = json::parse(run.out);
    EXPECT_EQ(report["kind"], "sphere-tree");
    EXPECT_EQ(report["depth"], 2);
    for (const json& level : report["levels"]) levels[i].push_back(level["spheres"]);
  }
  EXPECT_EQ(levels[0], levels[1]);
}

TEST(Inspect, RefusesWhatIsNoMeshAndNoTreeInOneLine) {
  const Workplace here;
  for (const std::string name : {"a.orchard", "a.sph", "a.obj", "a.txt"}) {
    const Finished run = here.run({"inspect", here.add(name, std::string("nothing of use\n"))});
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_EQ(run.out, "");
  }
}

TEST(Inspect, IsQuietWhenAsked) {
  const Workplace here;
  const Finished run = here.run({"inspect", here.add("l.obj", test::l_shape()), "--quiet"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out + run.err, "");
}

}  // namespace
}  // namespace orchard
