#include "output_folder.h"

#include "orchard/geometry/error.h"

namespace orchard::apps {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError(folder.string() + ": cannot be made a folder; choose another with -o");
}

std::filesystem::path in_folder(const std::filesystem::path& folder, const std::filesystem::path& model,
                                const char* ending) {
  std::filesystem::path file = folder / model.stem();
  file += ending;
  return file;
}

}  // namespace orchard::apps
