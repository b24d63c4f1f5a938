#pragma once
#include <span>

namespace orchard::apps {

// The exit codes of the program. Scripts rely on the numbers, so a meaning never changes its number.
enum ExitCode : int {
  kSucceeded = 0,
  kFailed = 1,          // a failure that is none of those below, or `verify` did not prove everything
  kBadInput = 2,        // an InputError or a mistake on the command line
  kAuditOpen = 3,       // `audit` found surface that is in no sphere
  kTooThin = 4,         // everything is written, and a measured thickness is below --fail-below
  kPromiseNotKept = 5,  // everything is written, and the result lacks a property that the command promises
  kInterrupted = 130,   // 128 + SIGINT; for other signals, the code is 128 + their number (interrupt.h)
};

struct ExitCodeRow {
  ExitCode code;
  const char* meaning;  // for users, as a sentence without its full stop
};

// One row for each code in ascending order: the table of the reference page and of the manual page.
std::span<const ExitCodeRow> exit_codes();

}  // namespace orchard::apps
