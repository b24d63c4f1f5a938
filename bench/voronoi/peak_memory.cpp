#include "peak_memory.h"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace orchard::bench {
namespace {

double status_bytes(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != field + ":") continue;
    double kilobytes = 0;
    status >> kilobytes;
    return 1024 * kilobytes;
  }
  return 0;
}

double measure(const std::function<void()>& run, bool warm) {
  // What the parent freed must neither be reused unseen nor what the run frees be kept: large blocks are mapped again.
  mallopt(M_MMAP_THRESHOLD, 1 << 16);
  mallopt(M_TRIM_THRESHOLD, 1 << 16);
  if (warm) run();  // brings the program's own pages in
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts from here
  const double before = status_bytes("VmRSS");
  run();
  return status_bytes("VmHWM") - before;
}

}  // namespace

double peak_bytes(const std::function<void()>& run, bool warm) {
  int channel[2];
  if (pipe(channel) != 0) return 0;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    const double bytes = measure(run, warm);
    const bool written = write(channel[1], &bytes, sizeof bytes) == sizeof bytes;
    _exit(written ? 0 : 1);
  }
  double bytes = 0;
  if (read(channel[0], &bytes, sizeof bytes) != sizeof bytes) bytes = 0;
  waitpid(child, nullptr, 0);
  close(channel[0]);
  close(channel[1]);
  return bytes;
}

}  // namespace orchard::bench
