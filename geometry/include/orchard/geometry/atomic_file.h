#pragma once
#include <filesystem>
#include <functional>
#include <ostream>
#include <string_view>

// Writes files so that a file is complete or does not exist.
namespace orchard {

// Writes a file completely or not at all: the contents go to a temporary name beside `path`, which is then renamed.
// Throws Error if the folder cannot be written or if `write` leaves the stream in a failed state; no file remains in
// that case.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace orchard
