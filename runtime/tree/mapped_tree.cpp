#include "orchard/runtime/tree_file.h"

#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#define ORCHARD_CAN_MAP 1
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace orchard::runtime {

MappedTree::MappedTree(MappedTree&& other) noexcept { *this = std::move(other); }

MappedTree& MappedTree::operator=(MappedTree&& other) noexcept {
  if (this == &other) return *this;
  close();
  view_ = std::exchange(other.view_, {});
  copy_ = std::exchange(other.copy_, {});  // moving vectors keeps their elements where they are
  bytes_ = std::exchange(other.bytes_, nullptr);
  size_ = std::exchange(other.size_, 0);
  return *this;
}

#ifdef ORCHARD_CAN_MAP

LoadStatus MappedTree::open(const char* path) noexcept {
  close();
  const int file = ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return LoadStatus::cannot_open;
  struct stat status {};
  const bool known = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  if (!known || status.st_size <= 0) {
    ::close(file);
    return known ? LoadStatus::truncated : LoadStatus::read_failed;
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
  ::close(file);
  if (bytes == MAP_FAILED) return LoadStatus::read_failed;
  bytes_ = bytes;
  size_ = size;
  LoadStatus result = runtime::view({static_cast<const std::byte*>(bytes), size}, view_);
  if (result == LoadStatus::ok) return result;
  close();
  if (result == LoadStatus::cannot_map) {
    result = load_file(path, copy_);
    view_ = copy_;
  }
  return result;
}

void MappedTree::close() noexcept {
  if (bytes_ != nullptr) ::munmap(bytes_, size_);
  bytes_ = nullptr;
  size_ = 0;
  view_ = {};
  copy_ = {};
}

#else

LoadStatus MappedTree::open(const char* path) noexcept {
  close();
  const LoadStatus result = load_file(path, copy_);
  if (result == LoadStatus::ok) view_ = copy_;
  return result;
}

void MappedTree::close() noexcept {
  view_ = {};
  copy_ = {};
}

#endif

}  // namespace orchard::runtime
