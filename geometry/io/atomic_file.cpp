#include "orchard/geometry/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <string>
#include <system_error>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// A name in the target's folder, so that renaming stays within one file system.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> count{0};
  std::filesystem::path name = path;
  return name += ".tmp-" + std::to_string(getpid()) + "-" + std::to_string(count++);
}

// Removes the file unless it has been renamed.
class Temporary {
 public:
  explicit Temporary(std::filesystem::path path) : path_(std::move(path)) {}
  ~Temporary() {
    std::error_code ignored;
    if (!renamed_) std::filesystem::remove(path_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::error_code rename_to(const std::filesystem::path& target) {
    std::error_code error;
    std::filesystem::rename(path_, target, error);
    renamed_ = !error;
    return error;
  }

 private:
  std::filesystem::path path_;
  bool renamed_ = false;
};

}  // namespace

void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  Temporary temporary(temporary_name(path));
  std::ofstream stream(temporary.path(), std::ios::binary | std::ios::trunc);
  if (!stream) throw Error(path.string() + ": cannot be written; check that its folder exists and is writable");
  write(stream);
  stream.close();
  if (!stream) throw Error(path.string() + ": writing failed; the disk may be full");
  if (const std::error_code error = temporary.rename_to(path)) {
    throw Error(path.string() + ": cannot be replaced: " + error.message());
  }
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  write_file(path,
             [&](std::ostream& stream) { stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

}  // namespace orchard
