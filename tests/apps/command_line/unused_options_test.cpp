#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

// Options that the others, or the input, leave nothing to do for.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

using Words = std::vector<std::string>;

struct Case {
  Words words;
  const char* fault;
};

// Each of the commands is refused before it works, and says so in one line that has the fault in it.
void expect_refused(const Workplace& here, const Words& command, const std::vector<Case>& cases) {
  for (const auto& [words, fault] : cases) {
    Words arguments = command;
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << fault;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(fault), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(here / "out")) << fault;
  }
}

TEST(UnusedOptions, MedialRefusesWhatItsInputOrOtherFlagsLeaveIdle) {
  const Workplace here;
  const std::string file = here.add("p.xyz", std::string("0 0 0\n"));
  // The files are not read yet when an option is refused.
  expect_refused(here, {"medial", here.add("l.obj", test::l_shape()), "-o", (here / "out").string()},
                 {{{"--points", file, "--samples", "500"}, "--samples has no effect with --points"},
                  {{"--points", file, "--crease-angle", "40"}, "--crease-angle has no effect with --points"},
                  {{"--diagram", file, "--relaxation", "clusters"}, "--relaxation has no effect with --diagram"},
                  {{"--diagram", file, "--max-passes", "3"}, "--max-passes has no effect with --diagram"},
                  {{"--diagram", file, "--algorithm", "exact"}, "--algorithm has no effect with --diagram"},
                  {{"--axis", file, "--samples", "500"}, "--samples has no effect with --axis, which builds nothing"},
                  {{"--axis", file, "--prune", "angle=20"}, "--prune angle has no effect with --axis"},
                  {{"--axis", file, "--segment-angle", "20"}, "--segment-angle has no effect with --axis"},
                  {{"--axis", file, "--raw"}, "--raw has no effect with --axis"},
                  {{"--gaps", "none", "--max-passes", "3"}, "--max-passes has no effect with --gaps none"},
                  {{"--gaps", "none", "--joined-radius", "2"}, "--joined-radius has no effect with --gaps none"},
                  {{"--gaps", "none", "--thin", "yes"}, "--thin has no effect with --gaps none"},
                  {{"--max-passes", "0", "--thin", "yes"}, "--thin has no effect with --max-passes 0"},
                  {{"--relaxation", "clusters", "--crease-angle", "40"}, "no effect with --relaxation clusters"},
                  {{"--edge-samples", "0", "--crease-angle", "40"}, "no effect with --edge-samples 0"},
                  {{"--raw", "--border-loss", "1"}, "--border-loss has no effect with --refine no (--raw)"},
                  {{"--refine", "no", "--feature-loss", "1"}, "--feature-loss has no effect with --refine no"},
                  {{"--raw", "--refine", "yes"}, "--refine"},
                  {{"--quality-samples", "500"}, "--quality-samples has no effect without --report"},
                  {{"--wrap-alpha", "0.02"}, "--wrap-alpha requires --wrap"}});
}

TEST(UnusedOptions, ASweepRefusesWhatNoneOfItsRunsHasAUseFor) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  expect_refused(here, {"medial", mesh, "-o", out},
                 {{{"--sweep", "segment-angle=20,40"}, "--segment-angle has no effect with --sweep"},
                  {{"--sweep", "samples=200,400", "--segment-angle", "20"}, "--segment-angle has no effect"},
                  {{"--sweep", "samples=200,400", "--samples", "300"}, "--samples has no effect with --sweep samples="},
                  {{"--sweep", "prune angle=0,20", "--sweep", "prune angle=40"}, "prune angle is given twice"},
                  {{"--sweep", "refine=no,yes", "--raw"}, "--raw has no effect with --sweep refine="},
                  {{"--sweep", "max-passes=1,2", "--gaps", "none"}, "--max-passes has no effect with --gaps none"},
                  {{"--sweep", "border-loss=1,2", "--raw"}, "--border-loss has no effect with --refine no"},
                  {{"--sweep", "gaps=none", "--thin", "yes"}, "--thin has no effect with --gaps none"}});
  // One run of the two has a use for it.
  const Finished run = here.run({"medial", mesh, "-o", out, "--sweep", "gaps=none,connected", "--max-passes", "3",
                                 "--samples", "200", "--quality-samples", "200", "--raw", "--json", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["runs"].size(), 2u) << "as everywhere, --json is printed whether --quiet or not";
}

TEST(UnusedOptions, BuildRefusesWhatItsMethodInputOrOtherFlagsLeaveIdle) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), file = here.add("p.xyz", std::string("0 0 0\n"));
  expect_refused(
      here, {"build", mesh, "-o", (here / "out").string(), "--no-views"},
      {{{"--method", "octree", "--effort", "low"}, "--effort has no effect on --method octree"},
       {{"--method", "merging", "--effort", "high"}, "it is for tightened and annealing"},
       {{"--method", "annealing", "--objective", "mean"}, "it is for tightened"},
       {{"--closing", "growth"}, "--closing has no effect on --method tightened; it is for merging"},
       {{"--energy", "sum"}, "it is for annealing"},
       {{"--anneal-move", "0.1"}, "--anneal-move has no effect on --method tightened; it is for annealing"},
       {{"--method", "octree", "--anneal-cooling", "0.8"}, "it is for annealing, and for others with --anneal"},
       {{"--method", "annealing", "--anneal"}, "which anneals anyway; leave it out"},
       {{"--method", "octree", "--gaps", "none"}, "--gaps has no effect on --method octree, which builds from no"},
       {{"--method", "octree", "--samples", "500"}, "it is for tightened and merging"},
       {{"--method", "annealing", "--prune", "angle=20"}, "--prune angle has no effect on --method annealing"},
       {{"--method", "annealing", "--points", file}, "--points has no effect on --method annealing"},
       {{"--points", file, "--samples", "500"}, "--samples has no effect with --points"},
       {{"--diagram", file, "--gaps", "none"}, "--gaps has no effect with --diagram"},
       {{"--from-axis", file, "--topology", "free"}, "--topology has no effect with --from-axis"},
       {{"--gaps", "none", "--max-passes", "3"}, "--max-passes has no effect with --gaps none"},
       {{"--no-views", "--up", "z"}, "--up has no effect with --no-views"},
       {{"--wrap-alpha", "0.02"}, "--wrap-alpha requires --wrap"},
       {{"--strict", "--wrap-alpha", "0.02"}, "--wrap-alpha requires --wrap"}});
  EXPECT_EQ(here.run(test::quick_build(mesh, (here / "out").string(), {"--seed", "3"})).exit_code, 0);
  const Words annealed{"build",      mesh,       "-o",       (here / "out").string(),
                       "--no-views", "--method", "octree",   "--depth",
                       "1",          "--anneal", "--energy", "sum",
                       "--effort",   "low"};
  EXPECT_EQ(here.run(annealed).exit_code, 0);
}

TEST(UnusedOptions, SampleAndVoronoiRefuseThemToo) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const std::string points = here.add("p.xyz", std::string("0 0 0\n1 0 0\n0 1 0\n0 0 1\n"));
  const Words creases{"--relaxation", "clusters", "--crease-angle", "40"};
  expect_refused(here, {"sample", mesh, "-o", out},
                 {{creases, "--crease-angle has no effect with --relaxation clusters"},
                  {{"--edge-samples", "0", "--crease-angle", "40"}, "no effect with --edge-samples 0"}});
  expect_refused(here, {"voronoi", mesh},
                 {{creases, "--crease-angle has no effect with --relaxation clusters"},
                  {{"--cells", "1,2"}, "--cells requires --output"},
                  {{"--box", "0", "0", "0", "1", "1", "1"}, "--box requires --output"},
                  {{"--compare", "--algorithm", "exact"}, "--algorithm"}});
  expect_refused(here, {"voronoi", points, "-o", out},
                 {{{"--samples", "500"}, "--samples has no effect on"}, {{"--crease-angle", "40"}, "has no faces"}});
  EXPECT_EQ(here.run({"voronoi", points, "--seed", "3"}).exit_code, 0)
      << "where nothing is random, any seed is kept to";
}

TEST(UnusedOptions, AFlagForOtherKindsOfFilesIsRefused) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), trees = (here / "trees").string();
  ASSERT_EQ(here.run(test::quick_build(ball, trees)).exit_code, 0);
  expect_refused(here, {"inspect", trees + "/ball.orchard"}, {{{"--full"}, "--full has no effect on "}});
  expect_refused(here, {"inspect", trees + "/ball.sph"}, {{{"--full"}, "--full has no effect on "}});
  expect_refused(here, {"verify", trees + "/ball.orchard", ball}, {{{"--bbox-center"}, "it is for .sph files"}});
  expect_refused(here, {"compare", ball, trees + "/ball.sph"}, {{{"--wrap-alpha", "0.02"}, "requires --wrap"}});
}

}  // namespace
}  // namespace orchard
