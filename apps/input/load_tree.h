#pragma once
#include <filesystem>

#include "orchard/runtime/packed_tree.h"

namespace orchard::apps {

// Reads an .orchard file. Throws InputError, in one line that says what to do, if it is none.
runtime::PackedSphereTree load_tree(const std::filesystem::path& file);

}  // namespace orchard::apps
