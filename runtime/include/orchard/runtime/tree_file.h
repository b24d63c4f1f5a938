#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/runtime/packed_tree.h"

// The native file of a packed sphere-tree, `.orchard`: byte by byte in docs/reference/formats.md.
namespace orchard::runtime {

enum class LoadStatus : std::uint8_t {
  ok,
  cannot_open,        // the file does not exist or may not be read
  read_failed,        // the system reported an error while reading
  truncated,          // shorter than its header says
  bad_magic,          // not an .orchard file
  version_newer,      // written by a later version of orchard
  version_older,      // written by an earlier one
  checksum_mismatch,  // altered after it was written
  invalid_structure,  // an intact file whose contents are not a tree that a query could walk safely
  out_of_memory,
  cannot_map,  // view() only: the bytes are not aligned, or this machine is big-endian
};

// One sentence without a full stop, for people. Never null.
const char* message(LoadStatus status) noexcept;

// The bytes of a tree; the same tree gives the same bytes on every machine. Throws std::bad_alloc only: this is for the
// side that builds trees. Precondition: structure_fault(tree) == nullptr.
std::vector<std::byte> serialize(const TreeView& tree);

// Reads a tree from any bytes whatever. Unless `ok` is returned, `out` is as it was. Needs no more memory than the file
// is long; counts are checked against the file's size before anything is allocated. A tree that loads has no
// structure_fault(), so no query on it leaves its arrays.
LoadStatus load(std::span<const std::byte> file, PackedSphereTree& out) noexcept;
LoadStatus load_file(const char* path, PackedSphereTree& out) noexcept;

// The same without a copy: `out` refers to `file`, which must outlive it unchanged. For files mapped into memory (see
// MappedTree) and for trees linked into a program. The bytes must begin at a multiple of kViewAlignment.
// Nothing is allocated; everything is checked, in one pass over the bytes.
inline constexpr std::size_t kViewAlignment = 32;
LoadStatus view(std::span<const std::byte> file, TreeView& out) noexcept;

// A tree used in place in a file that the system maps into memory (POSIX; elsewhere, and on big-endian machines, the
// file is read instead). Pages are shared between processes. The file must stay as it is meanwhile: if another
// program cuts it short, the next query receives SIGBUS, and if another program writes into it, queries leave their
// arrays. Replace it by renaming another one over it, as orchard does; where others may write to it, use load_file(),
// which copies it into memory.
class MappedTree {
 public:
  MappedTree() = default;
  ~MappedTree() { close(); }
  MappedTree(MappedTree&& other) noexcept;
  MappedTree& operator=(MappedTree&& other) noexcept;

  // Checks every byte, as view() does. Unless `ok` is returned, this object is empty.
  LoadStatus open(const char* path) noexcept;
  void close() noexcept;

  // Valid until close() or destruction; moving this object leaves views valid. Without blocks if nothing is open.
  const TreeView& view() const noexcept { return view_; }

 private:
  TreeView view_;
  PackedSphereTree copy_;  // where files cannot be mapped
  void* bytes_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace orchard::runtime
