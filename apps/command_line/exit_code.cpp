#include "command_line/exit_code.h"

#include <array>

namespace orchard::apps {

std::span<const ExitCodeRow> exit_codes() {
  static constexpr std::array kRows{
      ExitCodeRow{kSucceeded, "The command did what it was asked for; verify has proven everything"},
      ExitCodeRow{kFailed,
                  "Something failed that is not the input's fault, such as a full disk; or verify could not prove "
                  "everything"},
      ExitCodeRow{kBadInput,
                  "The command line, a file or a folder cannot be used; nothing is written, and one line on the "
                  "standard error output says why"},
      ExitCodeRow{kAuditOpen, "audit found surface that is in no sphere; everything is written"},
      ExitCodeRow{kTooThin,
                  "All files are written, and the solid is somewhere thinner than --fail-below; the report says where"},
      ExitCodeRow{kPromiseNotKept,
                  "All files are written, but the result lacks a property that the command promises; the report names "
                  "it"},
      ExitCodeRow{kInterrupted,
                  "Ctrl-C ended the command, and 128 + N any other signal N; files of an earlier run are as they "
                  "were"}};
  return kRows;
}

}  // namespace orchard::apps
