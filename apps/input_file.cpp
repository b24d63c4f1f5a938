#include "input_file.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "orchard/geometry/error.h"

namespace orchard::apps {

void check_input(const std::filesystem::path& file) {
  if (access(file.c_str(), R_OK) != 0)
    throw InputError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(file.string() + ": is a folder; name a file in it");
}

}  // namespace orchard::apps
