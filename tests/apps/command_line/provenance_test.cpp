#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"
#include "support/shapes.h"

// What files say about where they come from, and whose files a command may replace.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

namespace fs = std::filesystem;

// The text behind `Name="provenance"`, whose characters are written as numbers.
std::string field_data(const std::string& bytes) {
  const std::size_t name = bytes.find("Name=\"provenance\"");
  if (name == std::string::npos) return {};
  std::istringstream numbers(bytes.substr(bytes.find('>', name) + 1));
  std::string text;
  for (int number = 0; numbers >> number && number != 0;) text += static_cast<char>(number);
  return text;
}

std::string unescaped(std::string text) {
  for (std::size_t at = 0; (at = text.find("&quot;")) != std::string::npos;) text.replace(at, 6, "\"");
  return text;
}

// What a file says, by the format that its name says.
json provenance_in(const std::string& name, const std::string& bytes) {
  const std::string extension = fs::path(name).extension().string();
  if (extension == ".json") {
    const json parsed = json::parse(bytes);
    return parsed.is_array() ? parsed.at(0).value("provenance", json()) : parsed.value("provenance", json());
  }
  std::string text = extension == ".vtp" || extension == ".vtu" ? field_data(bytes) : bytes;
  if (extension == ".svg") text = unescaped(text);
  const std::string mark = extension == ".png"                          ? std::string("Comment\0orchard ", 16)
                           : extension == ".svg"                        ? "<metadata>orchard "
                           : extension == ".vtp" || extension == ".vtu" ? "orchard "
                           : bytes.starts_with("<?")                    ? "<?orchard "
                           : extension == ".ply"                        ? "\ncomment orchard "
                                                                        : "\n# orchard ";
  const std::size_t begin = text.find(mark);
  if (begin == std::string::npos) return {};
  std::istringstream stream(text.substr(begin + mark.size()));
  json found;
  stream >> found;  // up to the brace that ends it
  return found;
}

// Formats that other programs define down to the last byte, and the page, which holds the report.
bool says_nothing(const std::string& name) {
  static const std::vector<std::string> kWithout{".orchard", ".sph", ".xyz", ".html"};
  const std::string extension = fs::path(name).extension().string();
  return std::find(kWithout.begin(), kWithout.end(), extension) != kWithout.end();
}

void expect_in_all(const std::map<std::string, std::string>& files, const std::string& input) {
  for (const auto& [name, bytes] : files) {
    if (says_nothing(name)) continue;
    const json provenance = provenance_in(name, bytes);
    ASSERT_TRUE(provenance.is_object()) << name << " does not say where it comes from";
    EXPECT_EQ(provenance["inputs"][0]["file"], input) << name;
    EXPECT_EQ(provenance["inputs"][0]["checksum"].get<std::string>().size(), 16u) << name;
    EXPECT_TRUE(provenance["command_line"].get<std::string>().starts_with("orchard ")) << name;
    EXPECT_FALSE(provenance["version"].get<std::string>().empty()) << name;
    EXPECT_TRUE(provenance["options"].is_object()) << name;
    EXPECT_EQ(provenance["seed"], 7) << name;
  }
}

TEST(Provenance, IsInEveryFileOfEveryCommand) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  for (std::vector<std::string> run : std::vector<std::vector<std::string>>{
           {"build", mesh, "--samples", "150", "--depth", "1", "--export", "json,urdf", "--report", "--picture"},
           {"medial", mesh, "--samples", "150", "--report", "--quality-samples", "200", "--picture", "--vertices", "50",
            "--error-curve", "--envelope", out + "/l-envelope.obj", "--envelope-cell", "5"},
           {"medial", mesh, "--sweep", "samples=100", "--quality-samples", "100"},
           {"sample", mesh, "--samples", "200"},
           {"voronoi", mesh, "--samples", "150"}}) {
    run.insert(run.end(), {"--seed", "7", "-o", out, "--quiet"});
    const Finished finished = here.run(run);
    ASSERT_EQ(finished.exit_code, 0) << run[0] << finished.err;
  }
  const auto files = here.files("out");
  EXPECT_GT(files.size(), 50u);
  expect_in_all(files, "l.obj");
}

TEST(Provenance, IsInTheFilesOfSimulationsAndInThoseNamedByTheUser) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "trees").string();
  ASSERT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 0);
  const std::string tree = out + "/l.orchard", folder = (here / "out").string();
  fs::create_directory(folder);
  ASSERT_EQ(
      here.run({"simulate", "box", "--tree", tree, "--frames", "2", "--seed", "7", "-o", folder, "--quiet"}).exit_code,
      0);
  ASSERT_EQ(here.run({"profile", tree, "--flights", "3", "--seed", "7", "--plot", folder + "/p.svg", "--csv",
                      folder + "/p.csv", "--quiet"})
                .exit_code,
            0);
  const auto files = here.files("out");
  EXPECT_EQ(files.size(), 10u);  // four frames' files, run.pvd, two traces, the report, and the two that were named
  expect_in_all(files, "l.orchard");
  ASSERT_EQ(here.run({"compare", mesh, tree, "--plot", folder + "/c.svg", "--quiet"}).exit_code, 0);
  EXPECT_EQ(provenance_in("c.svg", here.files("out").at("c.svg"))["inputs"].size(), 2u);
}

// Twenty objects in the order in which their runs ended can be told apart.
TEST(Provenance, IsInWhateverIsPrintedAsJson) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  ASSERT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 0);
  const std::string tree = out + "/l.orchard";
  for (const std::vector<std::string>& run : std::vector<std::vector<std::string>>{
           test::quick_build(mesh, out),
           {"build", mesh, "-o", out, "--cost"},
           {"medial", mesh, "-o", out, "--samples", "300", "--no-views"},
           {"medial", mesh, "-o", out, "--sweep", "samples=100", "--quality-samples", "100"},
           {"sample", mesh, "-o", out, "--samples", "100", "--no-views"},
           {"voronoi", mesh, "--samples", "100"},
           {"inspect", mesh},
           {"inspect", tree},
           {"verify", tree, mesh},
           {"compare", mesh, tree},
           {"collide", tree, tree},
           {"profile", tree, "--flights", "3"},
           {"simulate", "box", "--tree", tree, "--frames", "1"}}) {
    std::vector<std::string> words = run;
    words.emplace_back("--json");
    const Finished finished = here.run(words);
    ASSERT_EQ(finished.exit_code, 0) << run[0] << finished.err;
    const json provenance = json::parse(finished.out)["provenance"];
    const std::string first = run[0] == "simulate" ? tree : run[1];
    EXPECT_EQ(provenance["inputs"][0]["file"], fs::path(first).filename().string()) << run[0];
    EXPECT_EQ(provenance["run"]["paths"][0], fs::canonical(first).string()) << run[0];
    EXPECT_NE(provenance["run"]["typed"].get<std::string>().find("--json"), std::string::npos) << run[0];
  }
}

TEST(Provenance, DependsOnNoFolderThreadOrOrderOfOptions) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  fs::create_directories(here / "elsewhere/deep");
  fs::copy_file(mesh, here / "elsewhere/deep/l.obj");
  const auto files = [&](std::vector<std::string> words, const std::string& folder) {
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    auto all = here.files(folder);
    std::erase_if(all, [](const auto& file) { return file.first == "l-medial.json" || file.first == "l.json"; });
    // ParaView's states name their folder.
    for (const char* state : {"l-build.pvsm", "l-medial.pvsm"}) all.erase(state);
    return all;
  };
  const auto one = files(
      {"medial", mesh, "-o", (here / "one").string(), "--samples", "150", "--prune", "angle=10", "--threads", "1"},
      "one");
  const auto two = files({"medial", "--quiet", "--prune", "angle=10", "--threads", "2", "--samples", "150",
                          (here / "elsewhere/deep/l.obj").string(), "-o", (here / "two/deep").string()},
                         "two");
  EXPECT_GT(one.size(), 1u);  // the axis and its simplification; views where they are built
  EXPECT_EQ(one, two);
  const auto tree =
      files({"build", mesh, "-o", (here / "three").string(), "--method", "octree", "--depth", "1"}, "three");
  EXPECT_EQ(tree, files({"build", "--depth", "1", (here / "elsewhere/../l.obj").string(), "--method", "octree", "-o",
                         (here / "four/below").string(), "--json"},
                        "four"));
}

TEST(Provenance, OfAMedialAxisIsBehindAllThatOtherReadersRead) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  ASSERT_EQ(here.run({"medial", mesh, "-o", out, "--raw", "--samples", "150", "--no-views", "--quiet"}).exit_code, 0);
  const std::string ma = here.files("out").at("l.ma");
  EXPECT_GT(ma.find("# orchard "), ma.rfind("\nf "));
  EXPECT_EQ(std::count(ma.begin(), ma.end(), '#'), 1);
  // orchard's own reader takes it.
  const Finished again = here.run({"medial", mesh, "-o", out, "--axis", out + "/l.ma", "--quality-samples", "200"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
}

// Two meshes of one name.
struct Namesakes {
  const Workplace here;
  const std::string out = (here / "out").string();
  std::string a, b;
  Namesakes() {
    for (const char* folder : {"a", "b"}) fs::create_directory(here / folder);
    a = here.add("a/part.obj", test::l_shape());
    b = here.add("b/part.obj", test::icosphere(1));
  }
};

TEST(Outputs, OfAnotherInputOfTheSameNameAreRefusedUnlessForced) {
  const Namesakes of;
  const std::vector<std::vector<std::string>> commands{{"build", "--method", "octree", "--depth", "1", "--no-views"},
                                                       {"medial", "--samples", "300", "--no-views"},
                                                       {"medial", "--sweep", "samples=100", "--quality-samples", "100"},
                                                       {"sample", "--samples", "100", "--no-views"},
                                                       {"voronoi", "--samples", "100"}};
  const auto run = [&](std::vector<std::string> words, const std::string& mesh, bool force) {
    words.insert(words.begin() + 1, mesh);
    words.insert(words.end(), {"-o", of.out});
    if (force) words.emplace_back("--force");
    return of.here.run(words);
  };
  for (const auto& words : commands) ASSERT_EQ(run(words, of.a, false).exit_code, 0) << words[0];
  const auto before = of.here.files("out");
  of.here.add("b/part.obj", std::string("f 1 2 3\n"));  // no mesh: it is refused before that is found
  for (const auto& words : commands) {
    const Finished refused = run(words, of.b, false);
    EXPECT_EQ(refused.exit_code, 2) << words[0];
    EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
    for (const std::string& part : {fs::canonical(of.a).string(), fs::canonical(of.b).string(), std::string("--force")})
      EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err;
  }
  EXPECT_EQ(of.here.files("out"), before);
  of.here.add("b/part.obj", test::icosphere(1));
  for (const auto& words : commands) {
    const Finished forced = run(words, of.b, true);
    EXPECT_EQ(forced.exit_code, 0) << words[0] << forced.err;
    EXPECT_EQ(run(words, of.a, false).exit_code, 2) << words[0];
  }
}

TEST(Outputs, OfTheSameMeshAreReplacedWhenItWasEditedCopiedOrLinked) {
  const Namesakes of;
  const auto build = [&](const std::string& mesh, const std::string& depth) {
    return of.here.run({"build", mesh, "-o", of.out, "--method", "octree", "--depth", depth, "--no-views"});
  };
  ASSERT_EQ(build(of.a, "1").exit_code, 0);
  EXPECT_EQ(build(of.a, "1").out.find("they replace"), std::string::npos);
  const Finished other = build(of.a, "2");
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_NE(other.out.find("they replace those of: orchard build part.obj --method octree --depth 1"),
            std::string::npos)
      << other.out;
  fs::copy_file(of.a, of.b, fs::copy_options::overwrite_existing);
  EXPECT_EQ(build(of.b, "2").exit_code, 0) << "a copy";
  of.here.add("b/part.obj", test::icosphere(1));
  EXPECT_EQ(build(of.b, "2").exit_code, 0) << "edited";
  fs::create_directory(of.here / "c");
  fs::create_symlink(of.b, of.here / "c/part.obj");
  EXPECT_EQ(build((of.here / "c/part.obj").string(), "2").exit_code, 0) << "linked";
  EXPECT_EQ(build(of.a, "2").exit_code, 2);
}

TEST(Outputs, WithoutAReportThatSaysWhoseTheyAreAreReplaced) {
  const Namesakes of;
  const auto build = [&](const std::string& mesh) {
    return of.here.run({"build", mesh, "-o", of.out, "--method", "octree", "--depth", "1", "--no-views"}).exit_code;
  };
  ASSERT_EQ(build(of.a), 0);
  of.here.add("out/part.json", std::string("{\"mesh\": {\"triangles\": 12}}"));  // as older versions wrote it
  EXPECT_EQ(build(of.b), 0);
  of.here.add("out/part.json", std::string("no JSON at all"));
  EXPECT_EQ(build(of.a), 0);
  fs::remove(of.here / "out/part.json");
  EXPECT_EQ(build(of.b), 0);
}

}  // namespace
}  // namespace orchard
