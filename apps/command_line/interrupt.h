#pragma once
#include "orchard/geometry/progress.h"

// How the program reacts to Ctrl-C (SIGINT; likewise SIGTERM, SIGHUP and SIGPIPE). While nothing is being written,
// there is nothing to remove, so the program ends at once. While a Writing exists, the signal is remembered. Functions
// that write call throw_if_interrupted() where no work is half done, files are removed by destructors, and the program
// ends with the Writing. In both cases the exit code is 128 + the number of the signal: 130 for Ctrl-C.
namespace orchard::apps {

// Begins to handle signals. A signal that is ignored, as after nohup, stays ignored.
void catch_interrupts();

void throw_if_interrupted();         // throws Cancelled
Progress cancelled_by_interrupts();  // for library calls: false after a signal

// Exists from before the first temporary file is made until after the last one is removed. There may be only one at a
// time.
class Writing {
 public:
  Writing();
  ~Writing();  // ends the program if a signal came
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
};

}  // namespace orchard::apps
