#pragma once
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

struct Cell {
  std::int32_t x = 0, y = 0, z = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
  friend auto operator<=>(const Cell&, const Cell&) = default;  // NOLINT(modernize-use-nullptr): no 0 here
};

// A grid of cubes (squares, for points with z = 0) that stores only what is occupied: Turk's spatial hash. Items of a
// cell are visited in ascending order, so sums over them do not depend on the hash.
class CellHash {
 public:
  CellHash(const Point& origin, double cell_size) : origin_(origin), inverse_(1 / cell_size) {}

  // Points farther than 2^31 cells from the origin are the caller's fault.
  Cell cell_of(const Point& p) const {
    const Vector v = (p - origin_) * inverse_;
    return {floored(v.x()), floored(v.y()), floored(v.z())};
  }
  // Item i is in cells[i]. O(n).
  void build(std::span<const Cell> cells) {
    std::size_t buckets = 16;
    while (buckets < cells.size()) buckets *= 2;
    mask_ = buckets - 1;
    ends_.assign(buckets + 1, 0);
    entries_.resize(cells.size());
    for (const Cell& cell : cells) ++ends_[bucket_of(cell) + 1];
    for (std::size_t b = 0; b < buckets; ++b) ends_[b + 1] += ends_[b];
    for (Index i = 0; i < cells.size(); ++i) entries_[ends_[bucket_of(cells[i])]++] = {cells[i], i};
    // Now ends_[b] is the end of bucket b, and the end of the one before is its beginning. A bucket may hold several
    // cells: bring the items of each together.
    for (std::size_t b = 0; b < buckets; ++b) {
      const auto first = entries_.begin() + (b == 0 ? 0 : ends_[b - 1]), last = entries_.begin() + ends_[b];
      if (std::any_of(first, last, [&](const Entry& e) { return e.cell != first->cell; }))
        std::stable_sort(first, last, [](const Entry& x, const Entry& y) { return x.cell < y.cell; });
    }
  }
  // Where the items of each occupied cell begin among the entries, and the number of entries at the end.
  std::vector<Index> runs() const {
    std::vector<Index> starts;
    for (Index e = 0; e < entries_.size(); ++e)
      if (e == 0 || entries_[e].cell != entries_[e - 1].cell) starts.push_back(e);
    starts.push_back(static_cast<Index>(entries_.size()));
    return starts;
  }
  struct Entry {
    Cell cell;
    Index item;
  };
  const Entry& entry(Index e) const { return entries_[e]; }

  template <class Visit>
  void visit(const Cell& cell, const Visit& visit_item) const {
    const std::size_t bucket = bucket_of(cell);
    for (Index i = bucket == 0 ? 0 : ends_[bucket - 1]; i < ends_[bucket]; ++i)
      if (entries_[i].cell == cell) visit_item(entries_[i].item);
  }
  // The items in the block of cells around `cell`: nine for dimension 2, 27 for 3.
  template <class Visit>
  void visit_block(const Cell& cell, int dimension, const Visit& visit_item) const {
    const int depth = dimension == 3 ? 1 : 0;
    for (int z = -depth; z <= depth; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) visit(Cell{cell.x + x, cell.y + y, cell.z + z}, visit_item);
  }

 private:
  static std::int32_t floored(double x) { return static_cast<std::int32_t>(std::floor(x)); }
  std::size_t bucket_of(const Cell& cell) const {
    const auto word = [](std::int32_t i) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)); };
    std::uint64_t h =
        word(cell.x) * 0x9e3779b97f4a7c15u ^ word(cell.y) * 0xc2b2ae3d27d4eb4fu ^ word(cell.z) * 0x165667b19e3779f9u;
    h ^= h >> 32;
    return static_cast<std::size_t>(h) & mask_;
  }

  Point origin_;
  double inverse_;
  std::size_t mask_ = 0;
  std::vector<Index> ends_;
  std::vector<Entry> entries_;
};

}  // namespace orchard::detail
