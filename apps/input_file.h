#pragma once
#include <filesystem>

namespace orchard::apps {

// For the beginning of a command: throws InputError in one line if there is no such file, if it is a folder, or if it
// may not be read.
void check_input(const std::filesystem::path& file);

}  // namespace orchard::apps
