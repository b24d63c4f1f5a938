#pragma once
#include <filesystem>
#include <functional>
#include <ostream>
#include <string_view>

namespace orchard {

// Writes a file as a whole or not at all: to a temporary name beside `path`, then renamed. Throws Error if the folder
// cannot be written or `write` leaves the stream in a failed state; then nothing stays behind.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace orchard
