#pragma once
#include <filesystem>

#include "orchard/runtime/packed_tree.h"

namespace orchard::apps {

// Reads an .orchard file. If the file is not valid, throws InputError with a message of one line that says what to do.
runtime::PackedSphereTree load_tree(const std::filesystem::path& file);

}  // namespace orchard::apps
