#pragma once
#include "commands.h"

namespace orchard::apps {

// Throws InputError if an option was given that the method, or the file in place of a step, leaves without effect:
// names it and says what it belongs to. `--seed` always passes: where nothing is random, any seed is kept to.
void refuse_idle_options(const BuildCommand& command);

}  // namespace orchard::apps
