#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

#include "orchard/geometry/mesh.h"

// A union-find structure.
namespace orchard {

// Disjoint sets of the items 0 to count - 1. At first each item is a set of its own.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), Index{0}); }
  // Returns the lowest item of the set that contains `item`. Shortens the paths on its way.
  Index root(Index item) {
    while (parents_[item] != item) item = parents_[item] = parents_[parents_[item]];
    return item;
  }
  // Unites the sets of two items.
  void unite(Index a, Index b) {
    a = root(a), b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parents_;
};

}  // namespace orchard
