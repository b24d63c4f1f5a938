#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "program.h"
#include "support/shapes.h"

// Pictures of files, the page of a build, and what ParaView opens.
namespace orchard {
namespace {

using test::Finished;
using test::Workplace;

#ifdef ORCHARD_HAS_VIZ

bool no_display() { return std::system("command -v Xvfb > /dev/null") != 0; }

// Width and height, as a PNG's header has them.
std::pair<unsigned, unsigned> size_of(const std::string& png) {
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png.at(at + i));
    return value;
  };
  return {number(16), number(20)};
}

TEST(View, DrawsWhateverItIsGiven) {
  if (no_display()) GTEST_SKIP() << "Xvfb is not in PATH";
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const std::string points = here.add("points.xyz", std::string("0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n"));
  ASSERT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 0);
  ASSERT_EQ(here.run({"medial", mesh, "-o", out, "--raw", "--samples", "300", "--no-views", "--quiet"}).exit_code, 0);
  ASSERT_EQ(here.run({"voronoi", points, "-o", out, "--quiet"}).exit_code, 0);
  const auto made = here.files("out");
  for (const auto& files : std::vector<std::vector<std::string>>{{mesh},
                                                                 {points},
                                                                 {out + "/l.orchard", mesh},
                                                                 {out + "/l.sph"},
                                                                 {out + "/l.ma", mesh},
                                                                 {out + "/points-highest-first.vor"}}) {
    std::vector<std::string> arguments{"view"};
    arguments.insert(arguments.end(), files.begin(), files.end());
    for (const std::string& word : {(here / "view.png").string()}) arguments.insert(arguments.end(), {"-o", word});
    arguments.insert(arguments.end(), {"--size", "200x160"});
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 0) << files.front() << ": " << run.err;
    const std::string png = here.files("")["view.png"];
    ASSERT_GT(png.size(), 500u) << files.front();
    EXPECT_EQ(size_of(png), std::pair(200u, 160u)) << files.front();
  }
}

TEST(View, DrawsAPanelForEachLevel) {
  if (no_display()) GTEST_SKIP() << "Xvfb is not in PATH";
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(2)), out = (here / "out").string();
  ASSERT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 0);
  const auto width = [&](const std::string& levels) {
    const Finished run =
        here.run({"view", out + "/ball.orchard", "-o", (here / "view.png").string(), "--level", levels, "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    return size_of(here.files("")["view.png"]).first;
  };
  EXPECT_EQ(width("0,1,2"), 3 * width("1"));
}

TEST(View, MakesFiguresWithAColorBarPartsBesideEachOtherAndNoGround) {
  if (no_display()) GTEST_SKIP() << "Xvfb is not in PATH";
  const Workplace here;
  const std::string mesh = here.add("rod.obj", test::box({0, 0, 0}, {6, 2, 2})), picture = (here / "v.png").string();
  const std::string axis = here.add("rod.ma", std::string("3 2 0\nv 1 1 1 1\nv 3 1 1 1\nv 5 1 1 .5\ne 0 1\ne 1 2\n"));
  const auto drawn = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"view", axis, mesh, "-o", picture, "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished run = here.run(all);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return here.files("").at("v.png");
  };
  const unsigned plain = size_of(drawn({})).first;
  EXPECT_GT(size_of(drawn({"--color", "radius", "--range", "0,1"})).first, plain) << "the bar is beside the picture";
  EXPECT_EQ(size_of(drawn({"--layout", "beside"})).first, plain) << "one axis, with the mesh around it";
  const std::string glass =
      drawn({"--transparent", "--balls", "--clip", "1,0,0,3", "--look-at", "3,1,1", "--width", "4"});
  EXPECT_EQ(glass.at(25), 6) << "red, green, blue and opacity";
  const Finished run = here.run({"view", axis, "-o", picture, "--turn", "2", "--size", "64x64", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto files = here.files("");
  EXPECT_NE(files.at("v-001.png"), files.at("v-002.png"));
}

TEST(View, RefusesWhatItCannotDraw) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  ASSERT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 0);
  const std::string tree = out + "/ball.orchard", picture = (here / "view.png").string();
  const struct {
    std::vector<std::string> arguments;
    const char* named;
  } cases[] = {{{tree}, "-o PICTURE.png"},
               {{tree, "-o", (here / "view.jpg").string()}, "pictures are .png"},
               {{tree, "-o", picture, "--level", "9"}, "the deepest level there is is 2"},
               {{mesh, "-o", picture, "--level", "1"}, "there is no tree among the files"},
               {{tree, "-o", picture, "--camera", "30"}, "two angles"},
               {{tree, "-o", picture, "--camera", "30,95"}, "-80 to 80"},
               {{tree, "-o", picture, "--size", "30x40"}, "64 to 8192"},
               {{tree, "-o", picture, "--color", "colour"}, "they have branch, carried, error"},
               {{tree, "-o", picture, "--color", "radius", "--range", "3"}, "two numbers"},
               {{tree, "-o", picture, "--color", "radius", "--range", "3,3"}, "below the second"},
               {{tree, "-o", picture, "--look-at", "1,2"}, "three coordinates"},
               {{tree, "-o", picture, "--clip", "0,0,0,1"}, "no plane"},
               {{tree, "--window", "--edges"}, "no options of a figure"},
               {{(here / "none.obj").string(), "-o", picture}, "none.obj"}};
  for (const auto& [arguments, named] : cases) {
    std::vector<std::string> all{"view"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Finished run = here.run(all);
    EXPECT_EQ(run.exit_code, 2) << named;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
  }
  EXPECT_FALSE(here.files("").contains("view.png"));
}

// A program in a folder of its own, so that orchard-render is nowhere beside it.
TEST(View, SaysInOneLineWhatIsMissingToDraw) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1));
  std::filesystem::create_directory(here / "bin");
  std::filesystem::copy_file(ORCHARD_PROGRAM, here / "bin/orchard");
  const std::string err = (here / "err").string();
  const auto refused = [&](const std::vector<std::string>& more, const std::string& variable) {
    std::string command = "PATH=/nowhere " + variable + " " + (here / "bin/orchard").string() + " view " + mesh;
    for (const std::string& word : more) command += " " + word;
    const int status = std::system((command + " > " + (here / "out").string() + " 2> " + err).c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2);
    std::string line = here.files("").at("err");
    EXPECT_TRUE(test::is_one_line_error(line)) << line;
    return line;
  };
  const std::vector<std::string> picture{"-o", (here / "view.png").string()};
  for (const std::vector<std::string>& more : {picture, std::vector<std::string>{"--window"}})
    for (const char* part : {"orchard-render, is neither beside this one nor in PATH", "--target orchard_render",
                             "orchard-tools", "ORCHARD_RENDER"}) {
      const std::string line = refused(more, "ORCHARD_RENDER=");
      EXPECT_NE(line.find(part), std::string::npos) << line;
    }
  const std::string none = (here / "none").string();
  EXPECT_NE(refused(picture, "ORCHARD_RENDER=" + none).find(none + ", named as"), std::string::npos);
  EXPECT_NE(refused(picture, "ORCHARD_RENDER=" + none).find("is not there"), std::string::npos);
  EXPECT_NE(refused(picture, "ORCHARD_RENDER=" + mesh).find("cannot be run"), std::string::npos);
  EXPECT_FALSE(here.files("").contains("view.png"));
}

TEST(View, AWindowNeedsAScreen) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1));
  const char* const display = std::getenv("DISPLAY");
  const std::string before = display == nullptr ? "" : display;
  unsetenv("DISPLAY");
  const Finished run = here.run({"view", mesh, "--window"});
  if (display != nullptr) setenv("DISPLAY", before.c_str(), 1);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("DISPLAY is not set"), std::string::npos) << run.err;
}

TEST(Build, WritesWhatParaViewOpens) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  const Finished run = here.run({"build", mesh, "-o", (here / "out").string(), "--method", "octree", "--depth", "2"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  auto files = here.files("out");
  ASSERT_TRUE(files.contains("l-build.pvd") && files.contains("l-build-view.py"));
  for (const char* level : {"0", "1", "2"})
    EXPECT_NE(files["l-build.pvd"].find("timestep=\"" + std::string(level) + "\" part=\"0\" file=\"l-build-level-" +
                                        level + ".vtp\""),
              std::string::npos);
  EXPECT_NE(files["l-build-view.py"].find("LAST_LEVEL = 2\n"), std::string::npos);
}

TEST(Build, WritesAStateThatParaViewOpensFromAnywhere) {
  const Workplace here;
  const std::string mesh = here.add("l&l.obj", test::l_shape());
  const Finished run = here.run({"build", mesh, "-o", (here / "out").string(), "--method", "octree", "--depth", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string state = here.files("out").at("l&l-build.pvsm");
  const std::string folder = std::filesystem::absolute(here / "out").lexically_normal().string();
  for (const char* file : {"-mesh.vtp", ".pvd"})
    EXPECT_NE(state.find("value=\"" + folder + "/l&amp;l-build" + file + "\""), std::string::npos) << state;
}

#endif

TEST(Build, WritesAPageThatNeedsNothingElse) {
  const Workplace here;
  TriangleMesh mesh = test::icosphere(2);
  mesh.triangles.pop_back();
  const std::string file = here.add("a&b.obj", mesh);
  const Finished run = here.run(test::quick_build(file, (here / "out").string(), {"--report"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = here.files("out")["a&b-build-report.html"];
  ASSERT_FALSE(page.empty());
  for (const char* part : {"<h1>a&amp;b: build</h1>", "filled 1 hole", "conservative: every point of the repaired mesh",
                           "<svg", "<h3>seconds</h3>", "<h3>options</h3>", "octree", "inaccuracy"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  for (std::size_t svg = page.find("<svg"); svg != std::string::npos; svg = page.find("<svg", svg + 1))
    EXPECT_LT(page.find("viewBox=\"0 0 ", svg), page.find('>', svg)) << "it would be cut off";
  for (const char* outside : {"src=\"http", "href=", "<script", "<link"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_FALSE(here.files("out").contains("a&b.png")) << "the picture was not asked for by itself";
}

TEST(Build, SaysWhatTheAxisIsWorseFor) {
  const Workplace here;
  // Two boxes so near each other that few points cannot tell them apart.
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 0.02});
  const TriangleMesh other = test::box({0, 0, 0.022}, {1, 1, 0.042});
  const auto first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  const std::string file = here.add("plates.obj", mesh), out = (here / "out").string();
  const Finished poor = here.run({"build", file, "-o", out, "--samples", "100", "--gaps", "none", "--depth", "1",
                                  "--topology", "free", "--no-views", "--effort", "low"});
  ASSERT_EQ(poor.exit_code, 0) << poor.err;
  EXPECT_NE(poor.out.find("is not the solid's: it is in "), std::string::npos) << poor.out;
  const Finished good = here.run(test::quick_build(file, out));
  EXPECT_EQ(good.out.find("is not the solid's"), std::string::npos) << good.out;
}

}  // namespace
}  // namespace orchard
