#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Items 0 to count - 1, each a set of its own until it is united with others.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), Index{0}); }
  Index root(Index item) {
    while (parents_[item] != item) item = parents_[item] = parents_[parents_[item]];
    return item;
  }
  // The lowest item of a set is its root.
  void unite(Index a, Index b) {
    a = root(a), b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parents_;
};

}  // namespace orchard
