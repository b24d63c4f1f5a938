#include "free_extension.h"

#include <algorithm>

namespace orchard::detail {

bool FreeExtension::joined(Index a, Index b) const {
  return new_edges_.contains(key(a, b)) || std::binary_search(complex_.edges.begin(), complex_.edges.end(),
                                                              std::array<Index, 2>{std::min(a, b), std::max(a, b)});
}

Index FreeExtension::add_vertex(const ExactBall& ball) {
  complex_.balls.push_back(ball);
  used_.push_back(0);
  return complex_.size() - 1;
}

bool FreeExtension::add(Index a, Index b, Index c) {
  if (a == b || b == c || a == c) return false;
  const bool ab = joined(a, b), bc = joined(b, c), ca = joined(c, a);
  const int sides = (ab ? 1 : 0) + (bc ? 1 : 0) + (ca ? 1 : 0);
  const Index opposite = ab ? c : bc ? a : b;
  if (sides != 2 && !(sides == 1 && is_unused(opposite))) return false;
  for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
    new_edges_.insert(key(p, q));
    if (p >= first_new_) used_[p - first_new_] = 1;
  }
  added_.push_back({a, b, c});
  return true;
}

bool FreeExtension::add_edge(Index from, Index to) {
  if (from == to || !is_unused(to)) return false;
  new_edges_.insert(key(from, to));
  for (const Index v : {from, to}) {
    if (v >= first_new_) used_[v - first_new_] = 1;
  }
  added_edges_.push_back({from, to});
  return true;
}

void FreeExtension::add_strip(Index a, Index b, Index x, Index y) {
  if (x == y) {
    add(a, b, x);
  } else if (apart(a, y) < apart(b, x)) {
    add(a, b, y);
    add(a, y, x);
  } else {
    add(a, b, x);
    add(b, y, x);
  }
}

Index FreeExtension::finish() {
  std::vector<Index> number(used_.size(), kNone);
  Index size = first_new_;
  for (Index i = 0; i < used_.size(); ++i) {
    if (!used_[i]) continue;
    complex_.balls[size] = complex_.balls[first_new_ + i];
    number[i] = size++;
  }
  complex_.balls.resize(size);
  const auto renumber = [&](auto& cells) {
    for (auto& corners : cells) {
      for (Index& v : corners) {
        if (v >= first_new_) v = number[v - first_new_];
      }
    }
  };
  renumber(added_);
  renumber(added_edges_);
  insert_cells(complex_.edges, complex_.triangles, added_edges_, added_);
  return static_cast<Index>(added_.size() + added_edges_.size());
}

}  // namespace orchard::detail
