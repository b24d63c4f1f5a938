#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A four-wide bounding volume hierarchy over families of balls, each of which is interpolated linearly on up to three
// balls. A ball is a point (centre, radius) in four dimensions, so a family is a triangle there. Nodes are boxes in
// four dimensions, along the principal axes of the points in them.
//
// For a unit vector u, |q - c| - r is at least u * q - (u, 1) * (c, r). Over a box, (u, 1) * (c, r) is at most its
// value at the middle plus the contributions of the half axes. If u points from the middle to q, these contributions
// are almost 0 where the balls touch a surface near q, because along a medial sheet the radius changes such that (u, 1)
// is perpendicular to the sheet in four dimensions. Bounds from boxes of centres and from largest radii would be worse
// by the size of the box.
//
// Boxes are stored as floats, relative to the middle of the centres and scaled to size 1. Their bounds are lowered by
// more than the rounding. The values of items are computed by the callers in doubles.
class SupportTree {
 public:
  using Item = std::array<Sphere, 3>;  // the three balls; edges and single balls repeat some

  SupportTree() = default;
  explicit SupportTree(std::vector<Item> items);

  // Returns the minimum of `best` and value(item, balls of the item, minimum so far) over all items. Precondition:
  // value() is at least the minimum of |query - c| - r over the item. Items that cannot have the minimum are not
  // evaluated. A value below `enough` ends the search.
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
  using Float4 = float __attribute__((vector_size(16)));  // one number for each child
  static constexpr Index kItem = 0x80000000u;             // a child with a number from here on is an item
  static constexpr std::size_t kDepth = 128;              // room for three entries for each level of a balanced tree
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
    float slack;  // more than the rounding error of a bound
  };
  class Builder;

  Query localized(const Point& query) const;
  float limit_of(double value) const;
  void prefetch(Index child) const;
  void push_children(const Node& node, const Query& query, float limit, Entry* stack, std::size_t& size) const;

  Point center_ = Point::Zero();
  double scale_ = 1;            // a power of two
  std::vector<Item> items_;     // in the order of the leaves
  std::vector<Index> numbers_;  // the number of each item in the order given
  std::vector<Node> nodes_;
};

}  // namespace orchard::detail
