#pragma once
#include <array>

#include "detector/bodies.h"
#include "math/vector_functions.h"

namespace orchard::runtime::detail {

// A binary tree of axis-parallel boxes around the spheres of the parts of bodies, at the poses of one time.
class SphereTree {
 public:
  struct Part {
    Vec3 center{};
    double reach = 0;  // the radius
    BodyIndex body = kNoIndex;
    std::uint32_t part = 0;
  };

  void clear() noexcept { parts_.clear(), nodes_.clear(); }
  // Adds a sphere, enlarged by more than the errors of rotations and rounding.
  void add(const BoundingSphere& sphere, BodyIndex body, std::uint32_t part);
  // Builds the tree of the spheres that have been added, with at most `leaf` of them in a leaf. O(n log n).
  void build(std::uint32_t leaf = 4);
  std::span<const Part> parts() const noexcept { return parts_; }  // after build(), those of a leaf are adjacent
  // Calls visit(begin, end), a range of parts(), for each leaf that may have what is looked for. bound(low, high) is a
  // lower bound on its distance in a box, or on another measure, and boxes for which this is above most() are left out.
  // Of two siblings, the one with the smaller bound comes first.
  template <typename Bound, typename Most, typename Visit>
  void walk(const Bound& bound, const Most& most, const Visit& visit) const;
  std::size_t memory_bytes() const noexcept { return bytes_of(parts_, nodes_); }

 private:
  struct Node {
    Vec3 low{}, high{};
    std::uint32_t begin = 0, end = 0;  // a leaf's range of parts_
    std::uint32_t second = 0;          // the second child, or 0 for a leaf; the first child is the next node
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  std::vector<Part> parts_;
  std::vector<Node> nodes_;
  std::uint32_t leaf_ = 0;
};

// Returns the square of the distance of a point from a box.
inline double square_to_box(const Vec3& low, const Vec3& high, const Vec3& point) noexcept {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = max(max(low[i] - point[i], point[i] - high[i]), 0.0);
    square += way * way;
  }
  return square;
}

template <typename Bound, typename Most, typename Visit>
void SphereTree::walk(const Bound& bound, const Most& most, const Visit& visit) const {
  constexpr std::size_t kDeepest = 64;  // levels: halves of 2^32 parts are fewer
  struct Open {
    double bound;
    std::uint32_t node;
  };
  std::array<Open, 2 * kDeepest> open;
  std::size_t count = 0;
  const auto push = [&](std::uint32_t node) {
    const double least = bound(nodes_[node].low, nodes_[node].high);
    if (least <= most() && least < kInfinity) open[count++] = {least, node};
  };
  if (!nodes_.empty()) push(0);
  while (count > 0) {
    const Open top = open[--count];
    if (!(top.bound <= most())) continue;
    const Node& node = nodes_[top.node];
    if (node.second == 0) {
      visit(node.begin, node.end);
      continue;
    }
    const std::size_t before = count;
    push(top.node + 1), push(node.second);
    if (count == before + 2 && open[before].bound < open[before + 1].bound) std::swap(open[before], open[before + 1]);
  }
}

}  // namespace orchard::runtime::detail
