#include <gtest/gtest.h>

#include "batch/batch_support.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::kQuickTree;
using test::Workplace;
namespace fs = std::filesystem;

struct Refused {
  std::vector<std::string> words;
  std::string said;
};

TEST(Batch, RefusesBadInputInOneLineBeforeAnythingIsWritten) {
  const Workplace here;
  const auto path = [&](const char* name) { return (here / name).string(); };
  fs::create_directory(here / "meshes");
  fs::create_directory(here / "empty");
  here.add("meshes/a.obj", test::icosphere(1));
  here.add("list", std::string("meshes/a.obj\nmeshes/gone.obj\nmeshes/lost.ply\n"));
  here.add("nothing", std::string("# no mesh\n\n"));
  const std::string meshes = path("meshes"), out = path("out");
  for (const Refused& refused : std::vector<Refused>{
           {{path("empty"), "-o", out, "--", "build"}, "contains no mesh"},
           {{path("none"), "-o", out, "--", "build"}, "cannot be read"},
           {{path("list"), "-o", out, "--", "build"}, "meshes/lost.ply"},
           {{path("list"), "-o", out, "--", "build"}, "meshes/gone.obj"},
           {{path("nothing"), "-o", out, "--", "build"}, "names no mesh"},
           {{"/dev/zero", "-o", out, "--", "build"}, "neither a folder nor a file"},
           {{meshes, "-o", out, "--shard", "3/2", "--", "build"}, "--shard 3/2"},
           {{meshes, "-o", out, "--shard", "0/2", "--", "build"}, "--shard 0/2"},
           {{meshes, "-o", out, "--shard", "1", "--", "build"}, "--shard 1"},
           {{meshes, "-o", out}, "after --"},
           {{meshes, "-o", out, "--", "verify"}, "build, medial or spheres"},
           {{meshes, "-o", out, "--", "build", "--dept", "2"}, "--depth"},
           {{meshes, "-o", out, "--", "build", "-o", "x"}, "-o cannot be among"},
           {{meshes, "-o", out, "--", "build", "--method", "octree", "--objective", "mean"}, "--objective"},
           {{meshes, "-o", out, "--", "medial", "--axis", "a.ma"}, "belongs to one mesh"},
           {{meshes, "--", "build"}, "--output"},
           {{meshes, "-o", "/proc/nothing", "--", "build"}, "/proc/nothing"},
           {{"merge", meshes, "-o", out}, "batch.json"}}) {
    std::vector<std::string> words{"batch"};
    words.insert(words.end(), refused.words.begin(), refused.words.end());
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 2) << refused.said;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(refused.said), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(here / "out")) << refused.said;
  }
}

TEST(Batch, RefusesAFolderOfOtherOptionsAndAShardThatWasBegunUnlessItResumes) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  here.add("meshes/a.obj", test::icosphere(1));
  const std::vector<std::string> begin{"batch", (here / "meshes").string(), "-o", (here / "out").string()};
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = begin;
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  };
  ASSERT_EQ(run({"--", "build", "--method", "octree", "--depth", "1", "--no-views"}).exit_code, 0);
  const auto before = here.files("out");
  const Finished other = run({"--resume", "--", "build", "--method", "octree", "--depth", "2", "--no-views"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("--depth 1"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("--depth 2"), std::string::npos) << other.err;
  const Finished again = run({"--", "build", "--method", "octree", "--depth", "1", "--no-views"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("--resume"), std::string::npos) << again.err;
  EXPECT_EQ(here.files("out"), before);
  // The same options in another order, and what decides nothing.
  EXPECT_EQ(
      run({"--resume", "--", "build", "--no-views", "--threads", "2", "--depth=1", "--method", "octree"}).exit_code, 0);
}

TEST(Batch, MergeNamesTheShardsThatAreMissing) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  for (const char* name : {"a", "b", "c"}) here.add("meshes/" + std::string(name) + ".obj", test::icosphere(1));
  std::vector<std::string> words{"batch", (here / "meshes").string(), "-o", (here / "out").string(), "--shard", "2/3"};
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  ASSERT_EQ(here.run(words).exit_code, 0);
  const Finished merge = here.run({"batch", "merge", (here / "out").string(), "-o", (here / "table").string()});
  EXPECT_EQ(merge.exit_code, 2);
  EXPECT_NE(merge.err.find("1/3, 3/3"), std::string::npos) << merge.err;
  EXPECT_FALSE(fs::exists(here / "table"));
}

TEST(Batch, PredictsWhatShardsTakeForSlurm) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  for (const char* name : {"a", "b", "c"}) here.add("meshes/" + std::string(name) + ".obj", test::icosphere(2));
  const auto cost = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"batch", (here / "meshes").string(), "--cost", "--json", "--shard", "1/3"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  };
  const json few = cost({"--", "medial", "--raw", "--samples", "1000"});
  EXPECT_EQ(few["meshes"], 3);
  EXPECT_EQ(few["triangles"], 3 * 320);
  EXPECT_EQ(few["sbatch"][0], "#SBATCH --array=1-3");
  const json many = cost({"--", "medial", "--raw", "--samples", "100000"});
  EXPECT_GT(many["seconds"], 10 * few["seconds"].get<double>());
  EXPECT_GT(many["bytes_of_largest_shard"], 2 * few["bytes_of_largest_shard"].get<double>());
}

}  // namespace
}  // namespace orchard
