#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <span>
#include <vector>

#include "orchard/runtime/tree_file.h"
#include "support.h"

// The bytes of .orchard files, to look at and to damage.
namespace orchard::runtime::test {

inline constexpr std::size_t kChecksumAt = 16, kFileSizeAt = 24, kTableAt = 96, kHeaderSize = 320;

template <typename T>
T get(const std::vector<std::byte>& file, std::size_t at) {
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

template <typename T>
void put(std::vector<std::byte>& file, std::size_t at, T value) {
  std::memcpy(file.data() + at, &value, sizeof value);
}

// Written from docs/reference/formats.md, not from the implementation.
inline void seal(std::vector<std::byte>& file) {
  std::uint64_t h = 0x6f72636861726421;
  for (std::size_t at = 0; at + 8 <= file.size(); at += 8) {
    if (at == kChecksumAt) continue;
    h ^= get<std::uint64_t>(file, at);
    h *= 0x9e3779b97f4a7c15;
    h ^= h >> 32;
  }
  put(file, kChecksumAt, h);
}

inline bool same(const PackedSphereTree& a, const PackedSphereTree& b) { return serialize(a) == serialize(b); }

inline PackedSphereTree sample_tree() {
  return build_tree(l_shape(), {.branching = 3, .leaf_triangles = 2, .origin = {1e6, -0.125, 3}});
}

struct Aligned {  // a copy of some bytes where view() wants them, and not a byte more
  explicit Aligned(std::span<const std::byte> from)
      : bytes(static_cast<std::byte*>(::operator new (from.size(), std::align_val_t{kViewAlignment}))),
        size(from.size()) {
    if (size > 0) std::memcpy(bytes, from.data(), size);
  }
  ~Aligned() { ::operator delete (bytes, std::align_val_t{kViewAlignment}); }
  Aligned(const Aligned&) = delete;
  std::span<const std::byte> span() const { return {bytes, size}; }
  std::byte* bytes;
  std::size_t size;
};

// `out` must survive every failed load, and a view must agree.
inline LoadStatus load_or_keep(std::span<const std::byte> file) {
  TreeView seen;
  const Aligned aligned(file);
  const LoadStatus view_status = view(aligned.span(), seen);
  EXPECT_TRUE(view_status == LoadStatus::ok ? structure_fault(seen) == nullptr : seen.blocks.empty());
  const PackedSphereTree before = build_tree(box({0, 0, 0}, {1, 1, 1}));
  PackedSphereTree out = before;
  const LoadStatus status = load(file, out);
  EXPECT_EQ(status, view_status);
  EXPECT_EQ(structure_fault(out), nullptr);
  EXPECT_TRUE(status == LoadStatus::ok || same(before, out));
  if (status == LoadStatus::ok) {  // one tree, one form
    EXPECT_TRUE(std::ranges::equal(serialize(out), file));
    EXPECT_TRUE(std::ranges::equal(serialize(seen), file));
  }
  return status;
}

}  // namespace orchard::runtime::test
