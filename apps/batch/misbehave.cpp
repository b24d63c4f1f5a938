#include <fmt/core.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <vector>

#include "batch/misbehave.h"

namespace orchard::apps {

void misbehave(const std::string& kind) {
  constexpr std::size_t kPiece = std::size_t{16} << 20;
  constexpr unsigned kPieceMicroseconds = 5000;
  if (kind == "crash") std::raise(SIGSEGV);
  if (kind == "killed") std::raise(SIGKILL);
  std::vector<std::vector<char>> held;
  for (;;) {
    if (kind == "memory") held.emplace_back(kPiece, 'x');
    if (kind == "chatter")
      fmt::print("all work and no play\n");
    else
      usleep(kPieceMicroseconds);
  }
}

}  // namespace orchard::apps
