#include "batch/worker.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "batch/resident_memory.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

// It is still right after the file has been replaced by a newer one.
constexpr const char* kThisProgram = "/proc/self/exe";
constexpr int kBetweenLooks = 20;  // milliseconds
constexpr std::size_t kReportBytes = std::size_t{32} << 20, kLogBytes = std::size_t{32} << 10;
// Blocks that are read at a time, so that a process with endless output does not delay the check of the clock.
constexpr int kMostPieces = 64;
constexpr int kNotStarted = 127;

using Pipe = std::array<int, 2>;  // its end to read from, its end to write to

std::string why() { return std::generic_category().message(errno); }

// Runs in the new process, where no function that takes a lock may be called.
[[noreturn]] void become(char* const* words, const Pipe& out, const Pipe& err, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kNotStarted);  // the parent ended before prctl() took effect
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);  // core files of many crashes would fill the disk
  const int input = open("/dev/null", O_RDONLY);
  if (input >= 0) dup2(input, STDIN_FILENO);
  dup2(out[1], STDOUT_FILENO);
  dup2(err[1], STDERR_FILENO);
  execv(kThisProgram, words);
  _exit(kNotStarted);
}

Pipe new_pipe() {
  Pipe ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error("no process can be started: " + why());
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return ends;
}

}  // namespace

Worker::Worker(const std::vector<std::string>& words, const WorkerLimits& limits)
    : limits_(limits), output_{BoundedText(kReportBytes), BoundedText(kLogBytes)} {
  std::vector<std::string> all{"orchard"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  pointers.reserve(all.size() + 1);
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const Pipe out = new_pipe(), err = new_pipe();
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(pointers.data(), out, err, parent);
  const std::string reason = pid_ < 0 ? why() : std::string();
  close(out[1]);
  close(err[1]);
  pipes_ = {out[0], err[0]};
  running_ = pid_ > 0;
  if (!running_) {
    for (const int end : pipes_) close(end);
    throw Error("no process can be started: " + reason);
  }
  setpgid(pid_, pid_);  // called in both processes, because either may run first
}

Worker::~Worker() {
  if (running_) {
    kill_group();
    waitpid(pid_, nullptr, 0);
  }
  for (const int end : pipes_)
    if (end >= 0) close(end);
}

void Worker::kill_group() const { kill(-pid_, SIGKILL); }

void Worker::read_output() {
  std::array<char, 65536> piece{};
  for (std::size_t i = 0; i < pipes_.size(); ++i) {
    for (int pieces = 0; pipes_[i] >= 0 && pieces < kMostPieces; ++pieces) {
      const ssize_t count = read(pipes_[i], piece.data(), piece.size());
      if (count > 0) {
        output_[i].add({piece.data(), static_cast<std::size_t>(count)});
        continue;
      }
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) break;
      close(pipes_[i]);
      pipes_[i] = -1;
    }
  }
}

std::optional<WorkerEnd> Worker::look() {
  read_output();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  siginfo_t ended{};
  if (waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != pid_) {
    const std::uint64_t bytes = resident_memory(pid_);
    peak_bytes_ = std::max(peak_bytes_, bytes);
    if (limits_.seconds > 0 && seconds > limits_.seconds) broken_limit_ = WorkerEnd::Cause::out_of_time;
    if (limits_.bytes > 0 && bytes > limits_.bytes) broken_limit_ = WorkerEnd::Cause::out_of_memory;
    if (broken_limit_) kill_group();
    return std::nullopt;
  }
  kill_group();  // kills processes that it left behind, while their group still has its number
  int status = 0;
  rusage usage{};
  wait4(pid_, &status, 0, &usage);
  running_ = false;
  read_output();
  WorkerEnd end;
  end.cause = broken_limit_         ? *broken_limit_
              : WIFSIGNALED(status) ? WorkerEnd::Cause::signalled
                                    : WorkerEnd::Cause::exited;
  end.number = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  end.seconds = seconds;
  // The system counts from the memory of this process, which the new one shared until it became another program.
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  end.peak_bytes = peak_bytes_;
  if (usage.ru_maxrss > own.ru_maxrss)
    end.peak_bytes = std::max(peak_bytes_, static_cast<std::uint64_t>(usage.ru_maxrss) * 1024);
  end.out = output_[0].text();
  end.err = output_[1].text();
  end.out_whole = output_[0].whole();
  return end;
}

void wait_for_any(const std::vector<const Worker*>& workers) {
  std::vector<pollfd> watched;
  for (const Worker* worker : workers)
    for (const int descriptor : worker->descriptors()) watched.push_back({descriptor, POLLIN, 0});
  poll(watched.data(), watched.size(), kBetweenLooks);
}

}  // namespace orchard::apps
