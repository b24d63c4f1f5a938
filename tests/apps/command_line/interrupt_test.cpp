#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "program.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using test::Finished;
using test::Running;
using test::Workplace;

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A build of a minute and more.
std::vector<std::string> long_build(const std::string& mesh, const std::string& folder) {
  return {"build", mesh, "-o", folder, "--depth", "6", "--effort", "high", "--quiet"};
}

TEST(Interrupt, EndsABuildAtOnceWith130AndLeavesNothing) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(60, 30));
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
    Running program(long_build(mesh, (here / "out").string()), {}, here / "err");
    ASSERT_TRUE(program.listens());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_FALSE(program.ended()) << content(here / "err");
    program.send(signal);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(program.wait(), code);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
    EXPECT_EQ(content(here / "err"), "orchard: interrupted\n");
    EXPECT_FALSE(fs::exists(here / "out"));
  }
}

#ifdef ORCHARD_HAS_VIZ

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

bool lives(pid_t pid) { return kill(pid, 0) == 0; }

// A stand-in for the renderer that says that it has started, and then waits.
struct Picturing {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1));
  const fs::path out = here / "out", temporary = here / "tmp", started = here / "started";

  Picturing() {
    fs::create_directory(temporary);
    here.add("renderer", "#!/bin/sh\necho $$ > " + (here / "pid").string() + "\nmv " + (here / "pid").string() + " " +
                             started.string() + "\nexec sleep 60\n");
    fs::permissions(here / "renderer", fs::perms::owner_all);
  }

  std::vector<std::string> arguments() const {
    return {"build", mesh, "-o", out.string(), "--method", "octree", "--depth", "1", "--quiet", "--picture"};
  }
  std::vector<std::string> variables(const std::string& renderer) const {
    return {"ORCHARD_RENDER=" + renderer, "DISPLAY=:64999", "TMPDIR=" + temporary.string()};
  }
};

TEST(Interrupt, OfAPictureEndsTheRendererAndLeavesNoFile) {
  for (const bool terminal : {false, true}) {
    const Picturing picturing;
    Running program(picturing.arguments(), picturing.variables((picturing.here / "renderer").string()),
                    picturing.here / "err");
    ASSERT_TRUE(test::appears(picturing.started)) << content(picturing.here / "err");
    EXPECT_GT(entries(picturing.temporary), 0u);
    const pid_t renderer = std::stoi(content(picturing.started));
    ASSERT_TRUE(lives(renderer));
    if (terminal) {
      program.send_to_group(SIGINT);
    } else {
      program.send(SIGINT);
    }
    EXPECT_EQ(program.wait(), 130);
    EXPECT_FALSE(lives(renderer));
    EXPECT_EQ(entries(picturing.temporary), 0u);
    EXPECT_FALSE(fs::exists(picturing.out));
    EXPECT_EQ(content(picturing.here / "err"), "orchard: interrupted\n");
  }
}

TEST(Interrupt, LeavesTheFilesOfAnEarlierRunAsTheyWere) {
  const Picturing picturing;
  std::vector<std::string> earlier = picturing.arguments();
  earlier.pop_back();
  ASSERT_EQ(picturing.here.run(earlier).exit_code, 0);
  const auto before = picturing.here.files("out");
  std::vector<std::string> other = picturing.arguments();
  other[7] = "2";  // another depth
  Running program(other, picturing.variables((picturing.here / "renderer").string()), picturing.here / "err");
  ASSERT_TRUE(test::appears(picturing.started)) << content(picturing.here / "err");
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_EQ(picturing.here.files("out"), before);
  EXPECT_EQ(entries(picturing.out), before.size());
}

TEST(Interrupt, OfWhatReadsTheOutputLeavesNoHiddenFolder) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1));
  const Finished run =
      here.run({"build", mesh, "-o", (here / "out").string(), "--method", "octree", "--depth", "1"}, "&1 | true");
  EXPECT_EQ(run.exit_code, 0);  // that of `true`
  for (const auto& entry : fs::directory_iterator(here / "out")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

// Whenever the signal comes, there is all of the run or none of it. The renderer is the real one where it can draw.
TEST(Interrupt, AtAnyMomentLeavesAllOrNothing) {
  const Picturing picturing;
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(picturing.here.run(picturing.arguments()).exit_code, 0);
  using Duration = std::chrono::steady_clock::duration;
  const Duration duration = std::chrono::steady_clock::now() - begin;
  const std::size_t whole = picturing.here.files("out").size();
  fs::remove_all(picturing.out);
  int interrupted = 0;
  const auto interrupt_after = [&](Duration delay) {
    SCOPED_TRACE(delay.count());
    Running program(picturing.arguments(), {"TMPDIR=" + picturing.temporary.string()}, picturing.here / "err");
    std::this_thread::sleep_for(delay);
    program.send_to_group(SIGINT);
    const int code = program.wait();
    EXPECT_TRUE(program.ended());
    interrupted += code == 130 ? 1 : 0;  // 0: it was too late; -1: too early, the program had not begun
    EXPECT_EQ(entries(picturing.temporary), 0u);
    if (fs::exists(picturing.out)) {
      EXPECT_EQ(entries(picturing.out), whole) << "half of it, or a hidden folder";
    }
    fs::remove_all(picturing.out);
  };
  const int moments = 3 * static_cast<int>(test::more());
  for (int moment = 1; moment <= moments; ++moment) interrupt_after(duration * moment / moments);
  // Where the first run took so much longer than later ones that all of these were too late.
  for (Duration delay = duration / (2 * moments); interrupted == 0 && delay > std::chrono::milliseconds(1); delay /= 2)
    interrupt_after(delay);
  EXPECT_GT(interrupted, 0);
}

#endif

}  // namespace
}  // namespace orchard
