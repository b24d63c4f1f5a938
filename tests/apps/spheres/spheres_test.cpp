#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

std::vector<std::string> quick(const std::string& mesh, const std::string& folder, const std::vector<std::string>& more,
                               const std::string& spheres = "6") {
  std::vector<std::string> arguments{"spheres", mesh, "-o", folder, "--effort", "low", "--no-views", "-n", spheres};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Spheres, AreWrittenInEveryFormatThatAuditReads) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), folder = (here / "out").string();
  const Finished run = here.run(quick(mesh, folder, {"--export", "json,csv,urdf,yaml", "--tree"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("PROMISED: every point of the surface lies in a sphere; proven"), std::string::npos)
      << run.out;
  for (const char* file : {"l-set.txt", "l-set.csv", "l-set-spheres.json", "l-set.yml", "l-set.orchard"}) {
    const Finished audit = here.run({"audit", folder + "/" + file, mesh, "--json"});
    EXPECT_EQ(audit.exit_code, 0) << file << audit.err;
    EXPECT_EQ(json::parse(audit.out)["sets"][0]["spheres"], 6) << file;
  }
  EXPECT_NE(here.files("out").at("l-set.urdf").find("<sphere radius="), std::string::npos);
  EXPECT_EQ(here.run({"verify", folder + "/l-set.orchard", mesh}).exit_code, 0);
}

TEST(Spheres, EndWithFiveWhereTheErrorCannotBeReachedAndWriteTheBestSet) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), folder = (here / "out").string();
  const Finished run = here.run(quick(mesh, folder, {"--error", "0.01", "--json"}));
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_FALSE(json::parse(run.out)["promise"]["kept"].get<bool>());
  EXPECT_TRUE(here.files("out").contains("l-set.txt"));
}

TEST(Spheres, RefuseNumbersOutOfRangeOpenMeshesAndWhatIsOfNoUse) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  const std::string folder = (here / "out").string();
  for (const std::vector<std::string>& more : {std::vector<std::string>{"-n", "0"},
                                               {"-n", "2001"},
                                               {"-n", "6", "--fit", "inside", "--padding", "1"},
                                               {"-n", "6", "--overlap", "5"},
                                               {"-n", "6", "--clip", "0", "0", "1", "9"},
                                               {"-n", "6", "--weight", "0,0,0=2"},
                                               {"-n", "6", "--fit", "particles", "--weight", "0,0,0,1=2"},
                                               {"-n", "6", "--vertex-weights", "none.txt"}}) {
    std::vector<std::string> arguments{"spheres", mesh, "-o", folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << more.back();
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
  TriangleMesh holed = test::icosphere(2);
  for (int i = 0; i < 120; ++i) holed.triangles.pop_back();
  const Finished run = here.run({"spheres", here.add("holed.obj", holed), "-o", folder});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--wrap"), std::string::npos) << run.err;
  EXPECT_TRUE(here.files("out").empty());
}

TEST(Spheres, AsParticlesHaveMassesInEveryFormatThatHasAPlaceForThem) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), folder = (here / "out").string();
  const Finished run = here.run(quick(
      mesh, folder, {"--fit", "particles", "--equal", "--density", "2", "--export", "json,csv,urdf", "--json"}, "20"));
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const json report = json::parse(run.out)["particles"];
  EXPECT_NEAR(report["mass"].get<double>(), 6, 1e-9);
  EXPECT_TRUE(report["overlap_proven"].get<bool>());
  EXPECT_EQ(report["masses"].size(), 20);
  const auto files = here.files("out");
  EXPECT_EQ(json::parse(files.at("l-set-spheres.json"))["masses"].size(), 20);
  EXPECT_NE(files.at("l-set.csv").find("x,y,z,r,mass"), std::string::npos);
  EXPECT_NE(files.at("l-set.urdf").find("<mass value=\""), std::string::npos);
  const Finished audit = here.run({"audit", folder + "/l-set-spheres.json", mesh, "--json"});
  EXPECT_EQ(audit.exit_code, 3);
  const json body = json::parse(audit.out)["sets"][0]["particles"];
  EXPECT_NEAR(body["mass"].get<double>(), 6, 1e-9);
  EXPECT_NEAR(body["inertia_error"].get<double>(), report["inertia_error"].get<double>(), 1e-9);
}

TEST(Spheres, AsParticlesThatMissTheInertiaSayHowManyWouldDo) {
  const Workplace here;
  const std::string mesh = here.add("rod.obj", test::box(Point(0, 0, 0), Point(10, 1, 1)));
  const std::string folder = (here / "out").string();
  const Finished run = here.run(quick(mesh, folder, {"--fit", "particles", "--json"}, "1"));
  EXPECT_EQ(run.exit_code, 5);
  const json report = json::parse(run.out);
  EXPECT_FALSE(report["promise"]["kept"].get<bool>());
  EXPECT_GT(report["enough_spheres"].get<int>(), 1);
  EXPECT_NE(run.err.find("would do: -n "), std::string::npos) << run.err;
  EXPECT_NE(here.files("out").at("rod-set.txt").find("NOT AS ASKED FOR"), std::string::npos);
}

TEST(Spheres, OfAPartHoldThatPart) {
  const Workplace here;
  const std::string mesh = here.add("box.obj", test::box(Point(0, 0, 0), Point(1, 1, 4)));
  const std::string folder = (here / "out").string();
  const Finished run = here.run(quick(mesh, folder, {"--clip", "0", "0", "1", "3", "--json"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_NEAR(report["solid_volume"].get<double>(), 1, 1e-9);
  EXPECT_EQ(report["certified_mesh"], "box-clipped.obj");
  EXPECT_EQ(here.run({"audit", folder + "/box-set.txt", folder + "/box-clipped.obj"}).exit_code, 0);
  EXPECT_EQ(here.run({"audit", folder + "/box-set.txt", mesh}).exit_code, 3);
}

TEST(Spheres, AreWeightedByRegionsAndByVertices) {
  const Workplace here;
  const std::string mesh = here.add("box.obj", test::box(Point(0, 0, 0), Point(4, 1, 1)));
  const std::string weights = here.add("w.txt", "1\n1\n1\n1\n1\n1\n1\n9\n"), folder = (here / "out").string();
  EXPECT_EQ(here.run(quick(mesh, folder, {"--weight", "2,0,0,4,1,1=8", "--weight", "0,0,0,.5=3"})).exit_code, 0);
  EXPECT_EQ(here.run(quick(mesh, folder, {"--vertex-weights", weights})).exit_code, 0);
  const Finished few = here.run(quick(mesh, folder, {"--vertex-weights", here.add("few.txt", "1\n2\n")}));
  EXPECT_EQ(few.exit_code, 2);
  EXPECT_NE(few.err.find("8 vertices"), std::string::npos) << few.err;
  const Finished bad = here.run(quick(mesh, folder, {"--vertex-weights", here.add("bad.txt", "1\n-2\n")}));
  EXPECT_NE(bad.err.find("bad.txt, line 2"), std::string::npos) << bad.err;
}

TEST(Spheres, OfAFileBecomeATreeOfWhichTheirUnionIsTheObject) {
  const Workplace here;
  const std::string folder = (here / "out").string();
  const std::string a = here.add("a.txt", "0 0 0 1\n1.5 0 0 1\n3 0 0 .5\n"),
                    b = here.add("b.csv", "x,y,z,r\n0,0,0,1\n");
  for (const std::string& file : {a, b}) {
    const Finished run = here.run({"spheres", file, "-o", folder, "--tree", "--export", "urdf,json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("PROMISED: every point of the union"), std::string::npos) << run.out;
  }
  const auto answer = [&](const std::string& pose) {
    const Finished run =
        here.run({"collide", folder + "/a-set.orchard", folder + "/b-set.orchard", "--pose", pose, "--json"});
    return json::parse(run.out)["answer"].get<std::string>();
  };
  EXPECT_EQ(answer("4.49 0 0 1 0 0 0"), "maybe");
  EXPECT_EQ(answer("4.51 0 0 1 0 0 0"), "no");
  EXPECT_EQ(answer("1.5 1.99 0 1 0 0 0"), "maybe");
  EXPECT_EQ(answer("1.5 2.01 0 1 0 0 0"), "no");
  const Finished idle = here.run({"spheres", a, "-o", folder, "-n", "5"});
  EXPECT_EQ(idle.exit_code, 2);
  EXPECT_NE(idle.err.find("--spheres"), std::string::npos) << idle.err;
}

}  // namespace
}  // namespace orchard
