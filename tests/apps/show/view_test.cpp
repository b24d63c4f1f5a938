#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cctype>
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

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// Lengths of the lines of a path "M x y l dx dy ..", by the signs and blanks between its numbers.
std::size_t segments_of(const std::string& svg) {
  std::size_t numbers = 0;
  for (std::size_t path = svg.find(" d=\""); path != std::string::npos; path = svg.find(" d=\"", path + 1)) {
    bool in_line = false, in_number = false;
    for (std::size_t i = path + 4; svg[i] != '"'; ++i) {
      if (svg[i] == 'M') in_line = false;
      const bool digit = std::isdigit(static_cast<unsigned char>(svg[i])) != 0;
      if (in_line && digit && !in_number) ++numbers;
      in_number = digit;
      if (svg[i] == 'l') in_line = true;
    }
  }
  return numbers / 2;
}

TEST(View, DrawsTheVisibleEdgesOfABoxAsLinesWithoutADisplay) {
  const Workplace here;
  const std::string mesh = here.add("box&.obj", test::box({0, 0, 0}, {2, 2, 2})), svg = (here / "v.svg").string();
  const char* const display = std::getenv("DISPLAY");
  const std::string before = display == nullptr ? "" : display;
  unsetenv("DISPLAY");
  const Finished run = here.run({"view", mesh, "-o", svg, "--captions", "--size", "400x300", "--quiet"});
  const Finished pdf_run = here.run({"view", mesh, "-o", (here / "v.pdf").string(), "--captions", "--quiet"});
  if (display != nullptr) setenv("DISPLAY", before.c_str(), 1);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(pdf_run.exit_code, 0) << pdf_run.err;
  const std::string text = here.files("").at("v.svg"), pdf = here.files("").at("v.pdf");
  EXPECT_EQ(segments_of(text), 9u) << "three edges of a box are hidden\n" << text;
  EXPECT_NE(text.find(">box&amp;.obj</text>"), std::string::npos);
  EXPECT_NE(text.find("width=\"400pt\" height=\"300pt\""), std::string::npos);
  EXPECT_NE(text.find("<metadata>orchard {"), std::string::npos);
  EXPECT_TRUE(pdf.starts_with("%PDF-1.4\n") && pdf.ends_with("%%EOF\n"));
  EXPECT_NE(pdf.find("\n% orchard {"), std::string::npos);
  const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
  EXPECT_EQ(pdf.substr(table, 5), "xref\n") << "the place of the table is where it says";
  for (std::size_t i = 1, row = table + 9 + 20; i <= 6; ++i, row += 20)
    EXPECT_TRUE(pdf.substr(std::stoul(pdf.substr(row, 10))).starts_with(std::to_string(i) + " 0 obj")) << i;
}

TEST(View, DrawsBordersSeamsAndTheSolidInColorsOfTheirOwn) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  ASSERT_EQ(here.run({"medial", mesh, "-o", out, "--samples", "300", "--no-views", "--quiet"}).exit_code, 0);
  const auto drawn = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"view", out + "/l.ma", mesh, "-o", (here / "v.svg").string(), "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished run = here.run(all);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return here.files("").at("v.svg");
  };
  const std::string text = drawn({});
  for (const char* color : {"#000000", "#d55e00", "#9aa3ad"})
    EXPECT_NE(text.find(std::string("stroke=\"") + color), std::string::npos) << color;
  EXPECT_EQ(text.find("<text"), std::string::npos) << "captions come on request";
  EXPECT_EQ(drawn({"--opacity", "0"}).find("#9aa3ad"), std::string::npos) << "the solid is hidden";
  EXPECT_EQ(count_of(drawn({"--layout", "beside"}), "<path"), count_of(text, "<path"));
  EXPECT_LT(drawn({"--look-at", "0,0,0", "--width", "0.1"}).size(), text.size()) << "lines end at the sides";
  EXPECT_GT(segments_of(drawn({"--balls"})), 60u) << "outlines of balls";
}

TEST(View, DrawsSphereSetsAndSimulations) {
  if (no_display()) GTEST_SKIP() << "Xvfb is not in PATH";
  const Workplace here;
  const std::string spheres = here.add("set.txt", std::string("0 0 0 1\n3 0 0 1\n"));
  const std::string picture = (here / "v.png").string(), out = (here / "out").string();
  Finished run = here.run({"view", spheres, "-o", picture, "--size", "300x150", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(here.files("").at("v.png").size(), 3000u) << "shaded spheres, not dots";
  ASSERT_EQ(here.run({"simulate", "box", "--frames", "3", "-o", out, "--quiet"}).exit_code, 0);
  run = here.run({"view", out + "/box-run.pvd", "-o", picture, "--play", "--color", "answer", "--size", "160x120"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  auto files = here.files("");
  ASSERT_TRUE(files.contains("v-001.png") && files.contains("v-003.png") && !files.contains("v-004.png"));
  EXPECT_NE(files.at("v-001.png"), files.at("v-003.png"));
  run = here.run({"view", out + "/box-run.pvd", "-o", (here / "t.png").string(), "--turn", "2", "--size", "160x120"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  files = here.files("");
  EXPECT_NE(files.at("t-001.png"), files.at("t-002.png"));
  const struct {
    std::vector<std::string> arguments;
    const char* named;
  } cases[] = {
      {{out + "/box-run.pvd", "--frame", "9"}, "the series has 3 time steps"},
      {{spheres, "--play"}, "belong to a series"},
      {{here.add("a.pvd", std::string("<VTKFile>")), "--frame", "1"}, "no collection"},
      {{here.add("b.pvd", std::string("<VTKFile><Collection/></VTKFile>"))}, "no time step"},
      {{here.add("c.pvd", std::string("<VTKFile><Collection><DataSet file=\"gone.vtp\"/></Collection></VTKFile>"))},
       "gone.vtp"}};
  for (const auto& [arguments, named] : cases) {
    std::vector<std::string> all{"view", "-o", picture};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Finished refused = here.run(all);
    EXPECT_EQ(refused.exit_code, 2) << named;
    EXPECT_NE(refused.err.find(named), std::string::npos) << refused.err;
  }
}

TEST(View, ColorsByTheMapThatIsNamed) {
  if (no_display()) GTEST_SKIP() << "Xvfb is not in PATH";
  const Workplace here;
  const std::string axis = here.add("rod.ma", std::string("3 2 0\nv 1 1 1 1\nv 3 1 1 1\nv 5 1 1 .5\ne 0 1\ne 1 2\n"));
  const auto drawn = [&](const std::string& map) {
    const Finished run = here.run({"view", axis, "-o", (here / "v.png").string(), "--balls", "--color", "radius",
                                   "--map", map, "--size", "200x100", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return here.files("").at("v.png");
  };
  EXPECT_NE(drawn("viridis"), drawn("heat"));
  EXPECT_EQ(here.run({"view", axis, "-o", (here / "v.png").string(), "--map", "jet"}).exit_code, 2);
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
               {{tree, "-o", (here / "v.svg").string(), "--color", "radius"}, "a picture of lines"},
               {{tree, "-o", (here / "v.SVG").string()}, "small letters"},
               {{tree, "-o", (here / "v.pdf").string(), "--clip", "1,0,0,0"}, "cannot cut spheres"},
               {{tree, "-o", (here / "v.pdf").string(), "--window"}, "pictures are .png files"},
               {{tree, "-o", picture, "--level", "9"}, "the deepest level is 2"},
               {{mesh, "-o", picture, "--level", "1"}, "there is no tree among the files"},
               {{tree, "-o", picture, "--camera", "30"}, "two angles"},
               {{tree, "-o", picture, "--camera", "30,95"}, "-80 to 80"},
               {{tree, "-o", picture, "--size", "30x40"}, "64 to 8192"},
               {{tree, "-o", picture, "--color", "colour"}, "they have branch, carried, error"},
               {{tree, "-o", picture, "--color", "radius", "--range", "3"}, "two numbers"},
               {{tree, "-o", picture, "--color", "radius", "--range", "3,3"}, "below the second"},
               {{tree, "-o", picture, "--look-at", "1,2"}, "three coordinates"},
               {{tree, "-o", picture, "--clip", "0,0,0,1"}, "must not all be 0"},
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
