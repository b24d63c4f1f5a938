#pragma once
#include <CLI/CLI.hpp>

#include "commands.h"

namespace orchard::apps {

// The options of `orchard spheres` that say what a set is to be.
void add_set_options(CLI::App& command, SpheresCommand& spheres);

}  // namespace orchard::apps
