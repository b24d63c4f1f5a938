#include "batch/resident_memory.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace orchard::apps {

namespace fs = std::filesystem;

std::uint64_t resident_memory(pid_t process) {
  const fs::path folder = "/proc/" + std::to_string(process);
  std::uint64_t all = 0, resident = 0;
  if (!(std::ifstream(folder / "statm") >> all >> resident)) return 0;
  std::uint64_t bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  // Each thread has its own list of the processes that it started.
  std::error_code error;
  for (fs::directory_iterator thread(folder / "task", error), end; !error && thread != end; thread.increment(error)) {
    std::ifstream children(thread->path() / "children");
    for (pid_t child = 0; children >> child;) bytes += resident_memory(child);
  }
  return bytes;
}

}  // namespace orchard::apps
