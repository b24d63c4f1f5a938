#include "orchard/runtime/packed_tree.h"

#include <cstring>

#include "tree/tree_nodes.h"

namespace orchard::runtime {

namespace {

// A fingerprint of the stored bytes, eight at a time. It is equal for copies; trees that differ have the same one with
// a probability of 2^-64.
class Fingerprint {
 public:
  template <typename Container>
  void add(const Container& items) noexcept {
    const auto* bytes = reinterpret_cast<const unsigned char*>(items.data());
    std::size_t left = items.size() * sizeof(items[0]);
    mix(left);
    for (; left >= sizeof(std::uint64_t); left -= sizeof(std::uint64_t), bytes += sizeof(std::uint64_t)) {
      std::uint64_t word;
      std::memcpy(&word, bytes, sizeof word);
      mix(word);
    }
    std::uint64_t rest = 0;
    if (left > 0) std::memcpy(&rest, bytes, left);
    mix(rest);
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  void mix(std::uint64_t word) noexcept {  // a bijection of the value for each word, and of the word for each value
    value_ = (value_ ^ word) * 0x9e3779b97f4a7c15u;
    value_ ^= value_ >> 32;
  }
  std::uint64_t value_ = 0x243f6a8885a308d3u;
};

std::uint64_t fingerprint_of(const TreeView& tree) noexcept {
  Fingerprint print;
  print.add(tree.blocks), print.add(tree.triangles), print.add(tree.vertices), print.add(tree.leaf_triangles);
  print.add(
      std::array<double, 5>{tree.origin[0], tree.origin[1], tree.origin[2], tree.bounding_radius, tree.vertex_error});
  return print.value();
}

}  // namespace

PreparedTree::PreparedTree(const TreeView& view) noexcept : tree(view) {
  middle = detail::center_of(tree, 0);
  root = Vec3(middle) + tree.origin;
  const SiblingBlock& block = tree.blocks[0];
  radius = double{block.radius[0]}, reach = double{block.error[0]}, depth = double{block.depth[0]};
  bits = link_bits(tree.branching);
  extent = coordinate_extent(tree);
  error = detail::kStretch * (extent + length(tree.origin)) + tree.vertex_error;
  fingerprint = fingerprint_of(tree);
}

}  // namespace orchard::runtime
