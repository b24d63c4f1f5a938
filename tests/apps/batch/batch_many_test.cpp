#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "batch/batch_support.h"
#include "program.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::kQuickTree;
using test::Running;
using test::Workplace;
namespace fs = std::filesystem;

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
        EXPECT_TRUE(json::parse(test::content_of(result.path() / "row.json"), nullptr, false).is_object()) << result;
        EXPECT_TRUE(json::parse(test::content_of(result.path() / "cost.json"), nullptr, false).is_object()) << result;
      }
  }
  void wait_for_results(const std::string& out, std::size_t results, Running& program) const {
    while (test::results_in(here / out) < results && !program.ended())
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_FALSE(program.ended()) << test::content_of(here / "err");
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
    EXPECT_TRUE(test::content_of(one / file) == test::content_of(four / file)) << file;
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
  EXPECT_TRUE(test::content_of(many.here / "killed/shards/1-of-1.jsonl") ==
              test::content_of(many.here / "whole/shards/1-of-1.jsonl"));
  EXPECT_FALSE(fs::exists(many.here / "killed/.work"));
}

}  // namespace
}  // namespace orchard
