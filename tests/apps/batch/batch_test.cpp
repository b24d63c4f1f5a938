#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <map>
#include <thread>

#include "apps/batch/sha256.h"
#include "batch/batch_support.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::kQuickTree;
using test::Running;
using test::Workplace;
namespace fs = std::filesystem;

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
  EXPECT_EQ(test::content_of(here / "err"), "orchard: interrupted\n");
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
