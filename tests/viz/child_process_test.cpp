#include "child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>

#include "orchard/geometry/error.h"
#include "values.h"

namespace orchard::detail {
namespace {

using namespace std::chrono_literals;
using test::TestFolder;

Launch shell(const std::string& script, const std::filesystem::path& log) {
  return {.program = "/bin/sh", .arguments = {"-c", script}, .display = {}, .log = log};
}

bool has_children() { return waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD; }

TEST(ChildProcess, ReportsExitCodesAndSignals) {
  const TestFolder folder;
  ChildProcess good(shell("exit 0", folder / "log")), bad(shell("exit 7", folder / "log")),
      killed(shell("kill -ABRT $$", folder / "log"));
  const auto deadline = Clock::now() + 30s;
  EXPECT_EQ(good.wait_until(deadline), 0);
  EXPECT_EQ(WEXITSTATUS(bad.wait_until(deadline).value()), 7);
  EXPECT_EQ(WTERMSIG(killed.wait_until(deadline).value()), SIGABRT);
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, PassesDisplayArgumentsAndOutputThrough) {
  const TestFolder folder;
  Launch launch = shell("echo \"$DISPLAY $0 $1\"; echo error >&2", folder / "log");
  launch.arguments.insert(launch.arguments.end(), {"a b", "c;d"});
  launch.display = ":4711";
  EXPECT_EQ(ChildProcess(launch).wait_until(Clock::now() + 30s), 0);
  EXPECT_EQ(test::bytes_of(folder / "log"), ":4711 a b c;d\nerror\n");
}

TEST(ChildProcess, IsEndedAndReapedWithItsHandle) {
  const TestFolder folder;
  {
    ChildProcess endless(shell("exec sleep 1000", folder / "log"));
    EXPECT_EQ(endless.wait_until(Clock::now() + 10ms), std::nullopt);
  }
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, ThatDoesNotExistCannotBeStarted) {
  const TestFolder folder;
  EXPECT_THROW(ChildProcess({.program = folder / "nothing", .arguments = {}, .display = {}, .log = folder / "log"}),
               Error);
  EXPECT_FALSE(has_children());
}

TEST(VirtualDisplay, ThatFallsSilentOrEndsIsAnErrorAndLeavesNoProcess) {
  const TestFolder folder;
  const auto fake = [&](const std::string& name, const std::string& script) {
    std::ofstream(folder / name) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
    return folder / name;
  };
  EXPECT_THROW(VirtualDisplay(fake("ends", "exit 1"), folder / "log", 30s), Error);
  EXPECT_THROW(VirtualDisplay(fake("silent", "exec sleep 1000"), folder / "log", 50ms), Error);
  EXPECT_FALSE(has_children());
  EXPECT_EQ(VirtualDisplay(fake("good", "echo 12 >&3; exec sleep 1000"), folder / "log", 30s).name(), ":12");
  EXPECT_FALSE(has_children());
}

}  // namespace
}  // namespace orchard::detail
