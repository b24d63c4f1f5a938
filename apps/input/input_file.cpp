#include "input/input_file.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "orchard/geometry/error.h"

namespace orchard::apps {

void check_input(const std::filesystem::path& file) {
  if (access(file.c_str(), R_OK) != 0)
    throw InputError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(file.string() + ": this is a folder; name a file in it");
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": the file cannot be opened; check that it exists and its permissions");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace orchard::apps
