#include "orchard/runtime/tree_file.h"

#include <span>
#include <utility>

#include "execution/guarded.h"

#if defined(__unix__) || defined(__APPLE__)
#define ORCHARD_CAN_MAP 1
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace orchard::runtime {
namespace {

// Maps a file. `bytes` are valid as long as `mapped` exists. Returns cannot_map on systems that cannot map files.
LoadStatus map_file([[maybe_unused]] const char* path, [[maybe_unused]] std::shared_ptr<const void>& mapped,
                    [[maybe_unused]] std::span<const std::byte>& bytes) {
#ifdef ORCHARD_CAN_MAP
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return LoadStatus::cannot_open;
  struct stat status {};
  const bool known = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const auto size = known ? static_cast<std::size_t>(status.st_size) : 0;
  void* const begin = size > 0 ? ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0) : MAP_FAILED;
  ::close(file);
  if (begin == MAP_FAILED) return known && size == 0 ? LoadStatus::truncated : LoadStatus::read_failed;
  mapped = std::shared_ptr<const void>(begin, [size](const void* of) { ::munmap(const_cast<void*>(of), size); });
  bytes = {static_cast<const std::byte*>(begin), size};
  return LoadStatus::ok;
#else
  return LoadStatus::cannot_map;
#endif
}

}  // namespace

LoadStatus MappedTree::open(const char* path) noexcept {
  close();
  return detail::made_or(LoadStatus::out_of_memory, [&] {
    std::shared_ptr<const void> memory;
    std::span<const std::byte> bytes;
    LoadStatus result = map_file(path, memory, bytes);
    if (result == LoadStatus::ok) result = runtime::view(bytes, view_);
    if (result == LoadStatus::cannot_map) {
      const auto copy = std::make_shared<PackedSphereTree>();
      result = load_file(path, *copy);
      view_ = *copy, memory = copy;
    }
    if (result == LoadStatus::ok) memory_ = std::move(memory);
    return result;
  });
}

}  // namespace orchard::runtime
