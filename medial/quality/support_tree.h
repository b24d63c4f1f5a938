#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A four-wide bounding volume hierarchy over families of balls, each interpolated linearly on up to three: triangles of
// points in four dimensions, centre and radius. Nodes are boxes there, along the axes of what they hold.
//
// For a unit vector u, |q - c| - r is at least u * q - (u, 1) * (c, r), and (u, 1) * (c, r) is at most what it is at
// the middle of a box and what the box's half axes add. With u from the middle to q they add next to nothing where
// balls touch a surface near q: along a medial sheet the radius changes so that (u, 1) stands at right angles to the
// sheet in four dimensions. Bounds by boxes of centres and largest radii are worse by the size of the box.
//
// Boxes are floats around the middle of the centres, scaled to size one, and their bounds are low by more than what
// rounding does: values are the callers', in doubles.
class SupportTree {
 public:
  using Item = std::array<Sphere, 3>;  // the balls interpolated; edges and single balls repeat theirs

  SupportTree() = default;
  explicit SupportTree(std::vector<Item> items);

  // The least of `best` and value(item, balls of the item, least so far) over all items. Precondition: value() is at
  // least the least |query - c| - r of the item. Items that cannot be the least are not asked. A value below `enough`
  // ends the search.
  template <class Value>
  double min(const Point& query, double best, const Value& value,
             double enough = -std::numeric_limits<double>::infinity()) const {
    if (items_.empty()) return best;
    const Query local = localized(query);
    std::array<Entry, kDepth> stack;
    std::size_t size = 0;
    stack[size++] = {-std::numeric_limits<float>::infinity(), 0};
    float limit = limit_of(best);
    while (size > 0 && best >= enough) {
      const Entry entry = stack[--size];
      if (!(entry.bound < limit)) continue;
      if (entry.child >= kItem) {
        const Index item = entry.child - kItem;
        const double found = value(numbers_[item], items_[item], best);
        if (found < best) {
          best = found;
          limit = limit_of(best);
        }
        continue;
      }
      push_children(nodes_[entry.child], local, limit, stack.data(), size);
    }
    return best;
  }

 private:
  using Float4 = float __attribute__((vector_size(16)));  // side by side, one for each child
  static constexpr Index kItem = 0x80000000u;             // and more: a child that is an item
  static constexpr std::size_t kDepth = 128;              // three entries a level of a tree that is cut in the middle
  struct Entry {
    float bound;
    Index child;
  };
  struct Node {
    Float4 middle[4], half_axes[4][4];  // of the children's boxes; each half axis has four components
    Index child[4];                     // kNone: there is none
  };
  struct Query {
    Float4 place[3];
    float slack;  // what rounding may do to a bound, and more
  };
  class Builder;

  Query localized(const Point& query) const;
  float limit_of(double value) const;
  void prefetch(Index child) const;
  void push_children(const Node& node, const Query& query, float limit, Entry* stack, std::size_t& size) const;

  Point center_ = Point::Zero();
  double scale_ = 1;            // a power of two
  std::vector<Item> items_;     // in the order of the leaves
  std::vector<Index> numbers_;  // of each, as given
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
