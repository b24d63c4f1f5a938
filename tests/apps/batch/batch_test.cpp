#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "apps/batch/sha256.h"
#include "batch/batch_support.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Running;
using test::Workplace;
namespace fs = std::filesystem;

const std::vector<std::string> kQuickTree{"--", "build", "--method", "octree", "--depth", "1", "--no-views"};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Generated meshes, and batches on them.
struct Many {
  const Workplace here;
  const std::size_t count = test::batch_meshes();
  const std::vector<std::string> faults = test::add_batch_meshes(here, "meshes", count);

  std::vector<std::string> words(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"batch", (here / "meshes").string(), "-o", (here / out).string(), "--timeout", "5",
                                 "--json"};
    for (const auto* part : {&faults, &more, &kQuickTree}) all.insert(all.end(), part->begin(), part->end());
    return all;
  }
  json run(const std::string& out, const std::vector<std::string>& more = {}, int exit_code = 0) const {
    const Finished run = here.run(words(out, more));
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    return json::parse(run.out, nullptr, false);
  }
  fs::path merged(const std::string& out) const {
    const fs::path table = here / (out + "-table");
    const Finished run = here.run({"batch", "merge", (here / out).string(), "-o", table.string(), "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return table;
  }
  // Nothing is left of an interrupted run: no process, no file but results that are whole.
  void expect_nothing_half_done(const std::string& out) const {
    EXPECT_TRUE(test::all_end((here / out).string()));
    for (const auto& two : fs::directory_iterator(here / out / "results"))
      for (const auto& result : fs::directory_iterator(two)) {
        EXPECT_TRUE(json::parse(content(result.path() / "row.json"), nullptr, false).is_object()) << result;
        EXPECT_TRUE(json::parse(content(result.path() / "cost.json"), nullptr, false).is_object()) << result;
      }
  }
  void wait_for_results(const std::string& out, std::size_t results, Running& program) const {
    while (test::results_in(here / out) < results && !program.ended())
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_FALSE(program.ended()) << content(here / "err");
  }
};

TEST(BatchOfMany, GivesEveryMeshARowInOrderAndShardsMergeToTheSameBytes) {
  const Many many;
  many.run("whole");
  const std::vector<json> rows = test::rows_in(many.here / "whole/shards/1-of-1.jsonl");
  ASSERT_EQ(rows.size(), many.count);
  std::map<std::string, std::size_t> reasons;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i]["index"], i);
    EXPECT_EQ(rows[i]["status"], std::string(test::batch_status(i))) << rows[i];
    if (rows[i]["status"] == "failed") ++reasons[rows[i]["why"]];
  }
  const std::size_t each = many.count / 100;
  EXPECT_EQ(reasons, (std::map<std::string, std::size_t>{{"refused", 4 * each}, {"timeout", each}}));
  EXPECT_EQ(test::rows_in(many.here / "whole/shards/1-of-1.costs.jsonl").size(), many.count);

  for (const char* shard : {"3/4", "1/4", "4/4", "2/4"}) many.run("parts", {"--shard", shard, "--jobs", "3"});
  const fs::path one = many.merged("whole"), four = many.merged("parts");
  for (const char* file : {"batch.jsonl", "batch.csv", "batch-summary.json"})
    EXPECT_TRUE(content(one / file) == content(four / file)) << file;
  EXPECT_EQ(test::rows_in(one / "batch.jsonl"), rows);
  EXPECT_TRUE(fs::exists(one / "batch.svg"));
}

TEST(BatchOfMany, DoesOnlyWhatIsMissingAfterItAndItsWorkersWereKilledAtAnyMoment) {
  const Many many;
  many.run("whole");
  std::size_t before = 0;
  const std::size_t step = many.count / 5;
  for (std::size_t wanted = step; wanted < many.count - step; wanted += step) {
    Running program(many.words("killed", {"--resume"}), {}, many.here / "err");
    many.wait_for_results("killed", wanted, program);
    for (const pid_t process : test::processes_with((many.here / "killed").string()))
      if (process != program.pid()) kill(process, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    program.send(SIGKILL);  // not to its group: the workers have to end by themselves
    EXPECT_EQ(program.wait(), -1);
    many.expect_nothing_half_done("killed");
    EXPECT_GE(test::results_in(many.here / "killed"), std::max(before, wanted));
    before = test::results_in(many.here / "killed");
  }
  std::map<std::string, fs::file_time_type> made;
  for (const auto& entry : fs::recursive_directory_iterator(many.here / "killed/results"))
    if (entry.path().filename() == "row.json") made[entry.path().string()] = entry.last_write_time();
  const json counts = many.run("killed", {"--resume"});
  EXPECT_EQ(counts["known_before"], before);
  for (const auto& [file, time] : made) EXPECT_EQ(fs::last_write_time(file), time) << file << " was made twice";
  EXPECT_TRUE(content(many.here / "killed/shards/1-of-1.jsonl") == content(many.here / "whole/shards/1-of-1.jsonl"));
  EXPECT_FALSE(fs::exists(many.here / "killed/.work"));
}

TEST(Batch, TriesWorkersAgainThatWereKilledFromOutside) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  for (const char* name : {"a", "b", "c"}) here.add("meshes/" + std::string(name) + ".obj", test::icosphere(1));
  std::vector<std::string> words{
      "batch", (here / "meshes").string(), "-o", (here / "out").string(), "--jobs", "2", "--fault", "killed=b.obj"};
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  const Finished first = here.run(words);
  EXPECT_EQ(first.exit_code, 1);
  EXPECT_TRUE(test::is_one_line_error(first.err)) << first.err;
  EXPECT_NE(first.err.find("b.obj"), std::string::npos) << first.err;
  EXPECT_EQ(test::rows_in(here / "out/shards/1-of-1.jsonl").at(1)["why"], "killed");
  words[6] = "--resume", words[7] = "--json";
  const Finished second = here.run(words);
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(json::parse(second.out)["known_before"], 2);
  for (const json& row : test::rows_in(here / "out/shards/1-of-1.jsonl")) EXPECT_EQ(row["status"], "solid");
}

TEST(Batch, ChargesCrashesHangsMemoryAndChatterToTheirMeshesAlone) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  const std::map<std::string, std::string> whys{
      {"crash", "crashed"}, {"hang", "timeout"}, {"memory", "memory"}, {"chatter", "timeout"}};
  std::vector<std::string> words{
      "batch", (here / "meshes").string(), "-o", (here / "out").string(), "--timeout", "2", "--memory", "200"};
  here.add("meshes/well.obj", test::icosphere(1));
  for (const auto& [kind, why] : whys) {
    here.add("meshes/" + kind + ".obj", test::icosphere(1));
    words.insert(words.end(), {"--fault", kind + "=" + kind + ".obj"});
  }
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  const Finished run = here.run(words);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::vector<json> rows = test::rows_in(here / "out/shards/1-of-1.jsonl");
  ASSERT_EQ(rows.size(), whys.size() + 1);
  for (const json& row : rows) {
    const std::string kind = fs::path(row["mesh"].get<std::string>()).stem().string();
    EXPECT_EQ(row["why"], kind == "well" ? json() : json(whys.at(kind))) << row;
  }
  for (const json& cost : test::rows_in(here / "out/shards/1-of-1.costs.jsonl")) {
    EXPECT_LT(cost["seconds"], 4) << cost;
    EXPECT_LT(cost["peak_bytes"], 400 << 20) << cost;
  }
}

TEST(Batch, TriesAgainWhatFailedThroughALimitOnceThatIsLarger) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  here.add("meshes/slow.obj", test::icosphere(1));
  std::vector<std::string> words{"batch",     (here / "meshes").string(),
                                 "-o",        (here / "out").string(),
                                 "--resume",  "--json",
                                 "--timeout", "0.3",
                                 "--fault",   "hang=slow.obj"};
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  EXPECT_EQ(json::parse(here.run(words).out)["failures"]["timeout"], 1);
  EXPECT_EQ(json::parse(here.run(words).out)["known_before"], 1) << "the limit is the same";
  words[7] = "30", words[8] = "--jobs", words[9] = "1";
  EXPECT_EQ(json::parse(here.run(words).out)["statuses"]["solid"], 1);
}

TEST(Batch, EndsCleanlyByCtrlC) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  for (const char* name : {"a", "b", "c"}) here.add("meshes/" + std::string(name) + ".obj", test::icosphere(1));
  std::vector<std::string> words{
      "batch", (here / "meshes").string(), "-o", (here / "out").string(), "--jobs", "1", "--fault", "hang=c.obj"};
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  Running program(words, {}, here / "err");
  while (test::results_in(here / "out") < 1 && !program.ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  while (test::results_in(here / "out") < 2 && !program.ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_EQ(content(here / "err"), "orchard: interrupted\n");
  EXPECT_FALSE(fs::exists(here / "out/.work"));
  EXPECT_FALSE(fs::exists(here / "out/shards/1-of-1.jsonl"));
  EXPECT_EQ(test::results_in(here / "out"), 2u);
  EXPECT_TRUE(test::all_end((here / "out").string()));
}

// What a program writes to a terminal, until it ends.
std::string shown_on_terminal(const std::vector<std::string>& words) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) return "there is no terminal";
  std::string shown;
  Running program(words, {}, ptsname(terminal));
  std::array<char, 4096> piece{};
  for (bool ended = false; !ended;) {
    ended = program.ended();
    for (ssize_t count = 0; (count = read(terminal, piece.data(), piece.size())) > 0;)
      shown.append(piece.data(), static_cast<std::size_t>(count));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  close(terminal);
  return shown;
}

TEST(Batch, ShowsRateAndTimeLeftOnATerminalAndClearsTheLine) {
  const Workplace here;
  fs::create_directory(here / "meshes");
  for (const char* name : {"a", "b", "c", "d"}) here.add("meshes/" + std::string(name) + ".obj", test::icosphere(1));
  std::vector<std::string> words{"batch",     (here / "meshes").string(),
                                 "-o",        (here / "out").string(),
                                 "--jobs",    "1",
                                 "--timeout", "0.5",
                                 "--fault",   "hang=c.obj"};
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  const std::string shown = shown_on_terminal(words);
  EXPECT_NE(shown.find("2 of 4 meshes, 0 failed, "), std::string::npos) << shown;
  EXPECT_NE(shown.find(" a second, "), std::string::npos) << shown;
  EXPECT_NE(shown.find(" left"), std::string::npos) << shown;
  EXPECT_TRUE(shown.ends_with("\r")) << shown;
  words.insert(words.begin() + 4, {"--resume", "--quiet"});
  EXPECT_EQ(shown_on_terminal(words), "");
}

TEST(Batch, GivesEqualFilesOfTwoFoldersOneResult) {
  const Workplace here;
  fs::create_directories(here / "meshes/one");
  fs::create_directories(here / "meshes/two");
  for (const char* name : {"one/a.obj", "two/a.obj", "two/b.obj"})
    here.add("meshes/" + std::string(name), test::icosphere(1));
  std::vector<std::string> words{"batch", (here / "meshes").string(), "-o", (here / "meshes/out").string()};
  words.insert(words.end(), kQuickTree.begin(), kQuickTree.end());
  EXPECT_EQ(here.run(words).exit_code, 0);
  const std::vector<json> rows = test::rows_in(here / "meshes/out/shards/1-of-1.jsonl");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["key"], rows[1]["key"]);
  EXPECT_NE(rows[1]["key"], rows[2]["key"]);  // results carry the name
  EXPECT_EQ(test::results_in(here / "meshes/out"), 2u);
  words.insert(words.begin() + 4, "--resume");
  EXPECT_EQ(here.run(words).exit_code, 0);  // the folder of results is not searched for meshes
  EXPECT_EQ(test::rows_in(here / "meshes/out/shards/1-of-1.jsonl").size(), 3u);
}

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
           {{path("empty"), "-o", out, "--", "build"}, "holds no mesh"},
           {{path("none"), "-o", out, "--", "build"}, "cannot be read"},
           {{path("list"), "-o", out, "--", "build"}, "meshes/lost.ply"},
           {{path("list"), "-o", out, "--", "build"}, "meshes/gone.obj"},
           {{path("nothing"), "-o", out, "--", "build"}, "names no mesh"},
           {{"/dev/zero", "-o", out, "--", "build"}, "neither a folder nor a file"},
           {{meshes, "-o", out, "--shard", "3/2", "--", "build"}, "--shard 3/2"},
           {{meshes, "-o", out, "--shard", "0/2", "--", "build"}, "--shard 0/2"},
           {{meshes, "-o", out, "--shard", "1", "--", "build"}, "--shard 1"},
           {{meshes, "-o", out}, "behind --"},
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

TEST(Sha256, IsThatOfTheStandard) {
  const auto of = [](const std::string& text, std::size_t piece) {
    apps::Sha256 hash;
    for (std::size_t i = 0; i < text.size(); i += piece) hash.add(std::string_view(text).substr(i, piece));
    return hash.hexadecimal();
  };
  EXPECT_EQ(of("", 1), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(of("abc", 1), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const std::string million(1'000'000, 'a');
  for (const std::size_t piece : {std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{100'000}})
    EXPECT_EQ(of(million, piece), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0") << piece;
}

}  // namespace
}  // namespace orchard
