#pragma once
#include <filesystem>

namespace orchard::apps {

// Makes the folder if need be. Throws InputError if that cannot be.
void make_folder(const std::filesystem::path& folder);

inline constexpr const char* kWrapEnding = "-wrap.obj";  // of the wrap that a tree was built on, beside the tree

// FOLDER/NAME-OF-MODEL + ending.
std::filesystem::path in_folder(const std::filesystem::path& folder, const std::filesystem::path& model,
                                const char* ending);

}  // namespace orchard::apps
