#include "command_line/interrupt.h"

#include <unistd.h>
#include <csignal>
#include <cstring>

#include <atomic>
#include <cstdio>

#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

// The state is global because a signal handler can reach nothing else.
enum class State { idle, writing, ending };
std::atomic<State> state{State::idle};
std::atomic<int> received{0};
std::atomic<bool> on_terminal{false};
static_assert(std::atomic<State>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void write_text(const char* text) {
  // A failure cannot be reported anywhere.
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

// It calls only functions that are allowed in a signal handler.
[[noreturn]] void end(int number) {
  if (number != SIGPIPE) {  // which is how "orchard .. | head" ends
    if (on_terminal) write_text("\r                                                                      \r");
    write_text("orchard: interrupted\n");
  }
  _exit(128 + number);
}

extern "C" void on_signal(int number) {
  received = number;
  // The first to change the state wins: either nothing has been made yet, or the function that made it removes it.
  State expected = State::idle;
  if (state.compare_exchange_strong(expected, State::ending)) end(number);
}

}  // namespace

void catch_interrupts() {
  on_terminal = isatty(STDERR_FILENO) == 1;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
  }
}

void throw_if_interrupted() {
  if (received != 0) throw Cancelled();
}

Progress cancelled_by_interrupts() {
  return [](std::string_view, double) { return received == 0; };
}

Writing::Writing() {
  State expected = State::idle;
  if (state.compare_exchange_strong(expected, State::writing)) return;
  for (;;) pause();  // the program is ending in another thread
}

Writing::~Writing() {
  state = State::idle;
  if (received == 0) return;
  std::fflush(stdout);
  end(received);
}

}  // namespace orchard::apps
