#pragma once
#include "command_line/commands.h"

namespace orchard::apps {

// Each throws InputError if an option was given that the method, another option, or the file in place of a step, leaves
// without effect: names it and says what it belongs to. `--seed` always passes: where nothing is random, any seed is
// kept to. So does what is so anyhow, as `--report` with a sweep, which always measures. In a sweep, an option is idle
// that is so with every combination of the values.
void refuse_unused_options(const BuildCommand& command);
void refuse_unused_options(const MedialCommand& command);

}  // namespace orchard::apps
