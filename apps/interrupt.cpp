#include "interrupt.h"

#include <unistd.h>
#include <csignal>
#include <cstring>

#include <atomic>

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
  // There is nowhere to tell that this failed.
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

extern "C" void on_signal(int number) {
  received = number;
  // Whoever changes the state first wins: either nothing has been made yet, or its maker clears it away.
  State expected = State::idle;
  if (!state.compare_exchange_strong(expected, State::ending)) return;
  say_interrupted();
  _exit(exit_code_of_interrupt());
}

}  // namespace

void catch_interrupts() {
  on_terminal = isatty(STDERR_FILENO) == 1;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
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

int exit_code_of_interrupt() { return received == 0 ? 0 : 128 + received; }

// Nothing but what a signal handler may do.
void say_interrupted() {
  if (on_terminal) write_text("\r                                                                      \r");
  write_text("orchard: interrupted\n");
}

Writing::Writing() {
  State expected = State::idle;
  if (state.compare_exchange_strong(expected, State::writing)) return;
  for (;;) pause();  // the program is ending in another thread
}

Writing::~Writing() { state = State::idle; }

}  // namespace orchard::apps
