#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "orchard/geometry/error.h"

namespace orchard::detail {
namespace {

constexpr std::chrono::milliseconds kPollInterval{5};
constexpr std::chrono::seconds kPatienceAtEnd{2};  // the time between asking a program to end and killing it

std::vector<std::string> environment_with(const std::string& display) {
  std::vector<std::string> variables;
  for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
    if (display.empty() || !std::string_view(*variable).starts_with("DISPLAY=")) variables.emplace_back(*variable);
  }
  if (!display.empty()) variables.push_back("DISPLAY=" + display);
  return variables;
}

std::vector<char*> null_terminated(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  pointers.reserve(strings.size() + 1);
  for (std::string& text : strings) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

class FileActions {
 public:
  explicit FileActions(const Launch& launch) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
    if (!launch.log.empty()) {
      posix_spawn_file_actions_addopen(&actions_, 1, launch.log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
      posix_spawn_file_actions_adddup2(&actions_, 1, 2);
    }
    if (launch.passed_descriptor >= 0) posix_spawn_file_actions_adddup2(&actions_, launch.passed_descriptor, 3);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) throw Error(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  ~Pipe() {
    close(ends_[0]);
    close_writing_end();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading_end() const { return ends_[0]; }
  int writing_end() const { return ends_[1]; }
  void close_writing_end() {
    if (ends_[1] >= 0) close(std::exchange(ends_[1], -1));
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

// Returns one line without its end, or a part of it if the other side closes the pipe or the deadline passes.
std::string read_line(int descriptor, Clock::time_point deadline, const Progress& progress) {
  std::string line;
  for (;;) {
    report_progress(progress, "display", 0);
    if (Clock::now() >= deadline) return line;
    pollfd request{descriptor, POLLIN, 0};
    const int ready = poll(&request, 1, static_cast<int>(kPollInterval.count()));
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    char c = 0;
    if (ready <= 0 || read(descriptor, &c, 1) != 1 || c == '\n') return line;
    line += c;
  }
}

}  // namespace

ChildProcess::ChildProcess(const Launch& launch) {
  std::vector<std::string> arguments = launch.arguments;
  arguments.insert(arguments.begin(), launch.program.filename().string());
  std::vector<std::string> variables = environment_with(launch.display);
  const FileActions actions(launch);
  const int failure = posix_spawn(&pid_, launch.program.c_str(), actions.get(), nullptr,
                                  null_terminated(arguments).data(), null_terminated(variables).data());
  if (failure != 0) throw Error("cannot start " + launch.program.string() + ": " + std::strerror(failure));
}

ChildProcess::~ChildProcess() {
  if (ended_) return;
  kill(pid_, SIGTERM);
  if (wait_until(Clock::now() + kPatienceAtEnd)) return;
  kill(pid_, SIGKILL);
  wait_until(Clock::time_point::max());
}

std::optional<int> ChildProcess::wait_until(Clock::time_point deadline, const Progress& progress) {
  while (!ended_) {
    report_progress(progress, "picture", 0);
    int status = 0;
    const pid_t result = waitpid(pid_, &status, WNOHANG);
    if (result == pid_ ||
        (result < 0 && errno == ECHILD)) {  // ECHILD: this process ignores SIGCHLD, so the exit status is not known
      ended_ = result == pid_ ? status : 0;
    } else if (Clock::now() >= deadline) {
      break;
    } else {
      std::this_thread::sleep_for(kPollInterval);
    }
  }
  return ended_;
}

std::filesystem::path find_in_path(const std::string& name) {
  const char* value = std::getenv("PATH");
  std::string_view rest = value == nullptr ? "" : value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    std::filesystem::path file = std::filesystem::path(rest.substr(0, end)) / name;
    if (end > 0 && access(file.c_str(), X_OK) == 0) return file;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

VirtualDisplay::VirtualDisplay(const std::filesystem::path& xvfb, const std::filesystem::path& log,
                               Clock::duration patience, const Progress& progress) {
  Pipe pipe;
  // -terminate ends the server after its last client, in case this process is killed.
  server_.emplace(
      Launch{.program = xvfb,
             .arguments = {"-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-terminate", "5"},
             .display = {},
             .log = log,
             .passed_descriptor = pipe.writing_end()});
  pipe.close_writing_end();
  const std::string number = read_line(pipe.reading_end(), Clock::now() + patience, progress);
  if (number.empty()) throw Error("Xvfb did not start");
  name_ = ":" + number;
}

}  // namespace orchard::detail
