#pragma once
#include "orchard/geometry/progress.h"

// What Ctrl-C does (SIGINT; SIGTERM, SIGHUP and SIGPIPE likewise). While nothing is being written, and so there is
// nothing to clear away, the program ends at once. While a Writing lives the signal is remembered: what writes asks
// throw_if_interrupted() where nothing is half done, what was made is removed on the way out, and the end of
// the Writing is that of the program. Either way the exit code is 128 + the number of the signal: 130 for Ctrl-C.
namespace orchard::apps {

// From now on. A signal that is ignored, as by nohup, stays ignored.
void catch_interrupts();

void throw_if_interrupted();         // throws Cancelled
Progress cancelled_by_interrupts();  // for library calls: false after a signal

// From before the first temporary file is made until after the last one is gone. One at a time.
class Writing {
 public:
  Writing();
  ~Writing();  // ends the program if a signal came
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
};

}  // namespace orchard::apps
