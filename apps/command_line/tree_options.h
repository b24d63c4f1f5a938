#pragma once
#include <CLI/CLI.hpp>

#include "trees/tree_request.h"

namespace orchard::apps {

// The options of a command that say how to build a tree from a medial axis or a surface.
void add_tree_options(CLI::App& command, TreeRequest& tree);

const char* name(TreeMethod method);
const char* name(Effort effort);
const char* name(Objective objective);
const char* name(Selection selection);

}  // namespace orchard::apps
