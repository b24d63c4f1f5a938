#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "orchard/runtime/packed_tree.h"

// The native file of a packed sphere-tree, `.orchard`. docs/reference/formats.md describes it byte by byte.
namespace orchard::runtime {

// The result of reading a tree.
enum class LoadStatus : std::uint8_t {
  ok,
  cannot_open,        // The file does not exist or must not be read.
  read_failed,        // The system reported an error while reading.
  truncated,          // The file is shorter than its header states.
  bad_magic,          // It is not an .orchard file.
  version_newer,      // It was written by a later version of orchard.
  version_older,      // It was written by an earlier version.
  checksum_mismatch,  // It was altered after it was written.
  invalid_structure,  // The file is intact, but its contents are not a tree that queries can walk safely.
  out_of_memory,
  cannot_map,  // view() only: the bytes are not aligned.
};

// Returns a sentence without a full stop, for people. Never null.
const char* message(LoadStatus status) noexcept;

// Returns the bytes of a tree; the same tree gives the same bytes on every machine. Precondition: structure_fault(tree)
// == nullptr. Throws std::bad_alloc only: this is for programs that build trees.
std::vector<std::byte> serialize(const TreeView& tree);

// Reads a tree from any bytes. Unless `ok` is returned, `out` is unchanged. Needs no more memory than the length of the
// file; counts are checked against the file's size before memory is allocated. A tree that loads has no
// structure_fault(), so queries on it stay within its arrays.
LoadStatus load(std::span<const std::byte> file, PackedSphereTree& out) noexcept;
LoadStatus load_file(const char* path, PackedSphereTree& out) noexcept;

// The alignment that view() requires of the bytes.
inline constexpr std::size_t kViewAlignment = 32;
// Does the same without a copy: `out` refers to `file`, which must outlive it unchanged. Use it for files mapped into
// memory (see MappedTree) and for trees linked into a program. The bytes must begin at a multiple of kViewAlignment.
// Allocates nothing, and checks everything in one pass over the bytes.
LoadStatus view(std::span<const std::byte> file, TreeView& out) noexcept;

// A tree in a file that the system maps into memory (POSIX; elsewhere, the file is read instead). Pages are
// shared between processes.
// The file must not change meanwhile. If another program truncates it, the next query receives SIGBUS; if another
// program writes to it, queries may leave their arrays. To replace the file, rename another one over it, as orchard
// does. If other programs may write to it, use load_file(), which copies it into memory.
class MappedTree {
 public:
  // Opens a file and checks every byte, as view() does. Unless `ok` is returned, this object is empty.
  LoadStatus open(const char* path) noexcept;
  void close() noexcept { memory_.reset(); }

  // Returns the tree. The view is valid until close() or destruction of this object and of its copies. Without an open
  // file it has no blocks.
  TreeView view() const noexcept { return memory_ ? view_ : TreeView(); }

 private:
  TreeView view_;
  std::shared_ptr<const void> memory_;  // The mapped file or, where files cannot be mapped, a tree.
};

}  // namespace orchard::runtime
