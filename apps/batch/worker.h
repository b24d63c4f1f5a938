#pragma once
#include <poll.h>
#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/bounded_text.h"

namespace orchard::apps {

// Limits for one mesh; 0 means none. Memory is resident memory, because a limit of the address space would break
// programs that map files or start threads. It is checked every few hundredths of a second, so a process may exceed it
// for that long.
struct WorkerLimits {
  double seconds = 0;
  std::uint64_t bytes = 0;
};

// How a worker ended.
struct WorkerEnd {
  enum class Cause { exited, signalled, out_of_time, out_of_memory };
  Cause cause = Cause::exited;
  int number = 0;  // the exit code, or the signal
  double seconds = 0;
  std::uint64_t peak_bytes = 0;
  std::string out, err;  // what it printed
  bool out_whole = true;
};

// Runs this program on one mesh, as a process in a group of its own whose output is collected here. Signals from the
// terminal do not reach it. When this process ends, for any reason, the worker is killed.
class Worker {
 public:
  // words: a command and its options. Throws Error if no process can be started.
  Worker(const std::vector<std::string>& words, const WorkerLimits& limits);
  ~Worker();  // kills the group if it still runs
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Reads its output, checks the limits, and returns how it ended if it has.
  std::optional<WorkerEnd> look();
  // the descriptors of its output, for poll(); -1 after the end of the output
  const std::array<int, 2>& descriptors() const { return pipes_; }

 private:
  void kill_group() const;
  void read_output();

  WorkerLimits limits_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  pid_t pid_ = -1;
  bool running_ = false;
  std::array<int, 2> pipes_{-1, -1};
  std::array<BoundedText, 2> output_;
  std::uint64_t peak_bytes_ = 0;
  std::optional<WorkerEnd::Cause> broken_limit_;
};

// Returns when a worker has printed something or ended, after a signal, or after a few hundredths of a second.
void wait_for_any(const std::vector<const Worker*>& workers);

}  // namespace orchard::apps
