#pragma once
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"

// Runs other programs with deadlines (POSIX).
namespace orchard::detail {

using Clock = std::chrono::steady_clock;

struct Launch {
  std::filesystem::path program;
  std::vector<std::string> arguments;  // without the program's name
  std::string display;                 // $DISPLAY of the child; empty for the value of this process
  std::filesystem::path log;           // receives standard output and error; empty for those of this process
  int passed_descriptor = -1;          // it becomes descriptor 3 of the child
};

// A running program. The destructor ends it and waits for it.
class ChildProcess {
 public:
  explicit ChildProcess(const Launch& launch);  // throws Error if it cannot be started
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Returns the status of waitpid(), or nullopt if the program still runs at the deadline. Throws Cancelled if
  // `progress`, which is called every few milliseconds, returns false.
  std::optional<int> wait_until(Clock::time_point deadline, const Progress& progress = {});

 private:
  pid_t pid_ = -1;
  std::optional<int> ended_;
};

// Returns the path of a program in the folders of $PATH; empty if there is none.
std::filesystem::path find_in_path(const std::string& name);

// A virtual X server (Xvfb) that runs until this object is destroyed.
class VirtualDisplay {
 public:
  // Returns once the server accepts connections. Throws Error if that takes longer than `patience`, and Cancelled as
  // wait_until() does.
  VirtualDisplay(const std::filesystem::path& xvfb, const std::filesystem::path& log, Clock::duration patience,
                 const Progress& progress = {});
  const std::string& name() const { return name_; }

 private:
  std::optional<ChildProcess> server_;
  std::string name_;
};

}  // namespace orchard::detail
