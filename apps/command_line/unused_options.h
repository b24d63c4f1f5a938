#pragma once
#include "command_line/commands.h"

namespace orchard::apps {

// Each function throws InputError if an option was given that has no effect because of the method, another option, or a
// file that replaces a step. The message names the option and what it belongs to. `--seed` is always accepted: if
// nothing is random, every seed gives the same result. So are options that state what happens anyway, such as
// `--report` with a sweep, which always measures. In a sweep, an option is unused if it has no effect with any
// combination of the values.
void refuse_unused_options(const BuildCommand& command);
void refuse_unused_options(const MedialCommand& command);

}  // namespace orchard::apps
