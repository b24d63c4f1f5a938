#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// A map from ordered pairs of small numbers to a number that can be emptied in O(1). It uses a square array as long as
// the numbers are below kDense, which is nearly always so, and hashing beyond.
class EdgeTable {
 public:
  static constexpr Index kDense = 64;

  EdgeTable() : dense_(kCells) {}

  // Empties the table. Afterwards numbers below `count` may be used.
  void reset(Index count) {
    if (++epoch_ == 0) {
      dense_.assign(dense_.size(), Entry{});
      hashed_.assign(hashed_.size(), HashedEntry{});
      epoch_ = 1;
    }
    use_dense_ = count <= kDense;
    size_ = 0;
    if (!use_dense_ && hashed_.empty()) hashed_.resize(kCells);
  }

  // The value of the pair, or kNone.
  Index find(Index a, Index b) const {
    if (use_dense_) {
      const Entry& entry = dense_[a * kDense + b];
      return entry.epoch == epoch_ ? entry.value : kNone;
    }
    for (std::size_t at = home(a, b);; at = (at + 1) & (hashed_.size() - 1)) {
      if (hashed_[at].entry.epoch != epoch_) return kNone;
      if (hashed_[at].key == key(a, b)) return hashed_[at].entry.value;
    }
  }

  // Sets the value of a pair. If the pair has one already, changes nothing and returns false.
  bool insert(Index a, Index b, Index value) {
    if (use_dense_) {
      Entry& entry = dense_[a * kDense + b];
      if (entry.epoch == epoch_) return false;
      entry = {epoch_, value};
      return true;
    }
    std::size_t at = home(a, b);
    for (; hashed_[at].entry.epoch == epoch_; at = (at + 1) & (hashed_.size() - 1))
      if (hashed_[at].key == key(a, b)) return false;
    hashed_[at] = {{epoch_, value}, key(a, b)};
    if (2 * ++size_ > hashed_.size()) grow();
    return true;
  }

 private:
  static constexpr std::size_t kCells = std::size_t{kDense} * kDense;
  struct Entry {
    std::uint32_t epoch = 0;
    Index value = 0;
  };
  struct HashedEntry {
    Entry entry;
    std::uint64_t key = 0;
  };

  static std::uint64_t key(Index a, Index b) { return (static_cast<std::uint64_t>(a) << 32) | b; }
  std::size_t home(Index a, Index b) const { return ((key(a, b) * 0x9e3779b97f4a7c15u) >> 24) & (hashed_.size() - 1); }

  void grow() {
    std::vector<HashedEntry> old(2 * hashed_.size());
    old.swap(hashed_);
    for (const HashedEntry& entry : old) {
      if (entry.entry.epoch != epoch_) continue;
      std::size_t at = home(static_cast<Index>(entry.key >> 32), static_cast<Index>(entry.key));
      while (hashed_[at].entry.epoch == epoch_) at = (at + 1) & (hashed_.size() - 1);
      hashed_[at] = entry;
    }
  }

  std::uint32_t epoch_ = 1;
  std::size_t size_ = 0;  // number of hashed pairs
  bool use_dense_ = true;
  std::vector<Entry> dense_;
  std::vector<HashedEntry> hashed_;
};

}  // namespace orchard::detail
