#pragma once
#include "orchard/geometry/progress.h"

// What Ctrl-C does (SIGINT; SIGTERM and SIGHUP likewise). While nothing is being written, and so there is nothing to
// clear away, the program ends at once. While a Writing lives the signal is remembered; what writes asks
// throw_if_interrupted() where nothing is half done, and whoever made something removes it on the way out. Either way
// the exit code is 128 + the number of the signal: 130 for Ctrl-C.
namespace orchard::apps {

// From now on. A signal that is ignored, as by nohup, stays ignored.
void catch_interrupts();

void throw_if_interrupted();         // throws Cancelled
Progress cancelled_by_interrupts();  // for library calls: false after a signal
int exit_code_of_interrupt();        // 0: there was none
void say_interrupted();              // a line on stderr, over a progress bar

// From before the first temporary file is made until after the last one is gone. One at a time.
class Writing {
 public:
  Writing();
  ~Writing();
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
};

}  // namespace orchard::apps
