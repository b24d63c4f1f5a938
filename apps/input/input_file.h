#pragma once
#include <filesystem>
#include <string>

namespace orchard::apps {

// For the beginning of a command: throws InputError in one line if there is no such file, if it is a folder, or if it
// may not be read.
void check_input(const std::filesystem::path& file);

// All bytes of a file. Throws InputError if it cannot be opened.
std::string content_of(const std::filesystem::path& file);

// What a file is by the ending of its name, in lower case, with its dot: ".obj" of "LAMP.OBJ".
std::string lower_extension(const std::filesystem::path& file);

}  // namespace orchard::apps
