#pragma once
#include <cstddef>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/tree_file.h"

namespace orchard::runtime {

// A tree used in place in a file that the system maps into memory (POSIX; elsewhere, and on big-endian machines, the
// file is read instead). Pages are shared between processes. The file must stay as it is meanwhile: whoever cuts it
// short makes the program receive SIGBUS at the next query, and whoever writes into it makes queries leave their
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
