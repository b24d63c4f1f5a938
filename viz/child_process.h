#pragma once
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"

// Other programs, run with deadlines (POSIX).
namespace orchard::detail {

using Clock = std::chrono::steady_clock;

struct Launch {
  std::filesystem::path program;
  std::vector<std::string> arguments;  // without the program's name
  std::string display;                 // $DISPLAY of the child; empty: as here
  std::filesystem::path log;           // takes standard output and error; empty: they go where this one's go
  int passed_descriptor = -1;          // becomes descriptor 3 of the child
};

// A running program; the destructor ends and reaps it.
class ChildProcess {
 public:
  explicit ChildProcess(const Launch& launch);  // throws Error if it cannot be started
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // How it ended, as waitpid() has it; nothing while it still runs at the deadline. Throws Cancelled if `progress`,
  // which is asked every few milliseconds, wants no more.
  std::optional<int> wait_until(Clock::time_point deadline, const Progress& progress = {});

 private:
  pid_t pid_ = -1;
  std::optional<int> ended_;
};

// A program in the folders of $PATH; empty if there is none.
std::filesystem::path find_in_path(const std::string& name);

// A virtual X server (Xvfb) that lives as long as this value.
class VirtualDisplay {
 public:
  // Returns once the server takes connections. Throws Error if that takes longer than `patience`, and Cancelled as
  // wait_until() does.
  VirtualDisplay(const std::filesystem::path& xvfb, const std::filesystem::path& log, Clock::duration patience,
                 const Progress& progress = {});
  const std::string& name() const { return name_; }

 private:
  std::optional<ChildProcess> server_;
  std::string name_;
};

}  // namespace orchard::detail
