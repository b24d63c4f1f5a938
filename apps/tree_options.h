#pragma once
#include <CLI/CLI.hpp>

#include "pipeline.h"

namespace orchard::apps {

// The options of a command that say how to build a tree.
void add_tree_options(CLI::App& command, BuildOptions& options);

const char* name(Method method);
const char* name(Effort effort);
const char* name(Objective objective);

}  // namespace orchard::apps
