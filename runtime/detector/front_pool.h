#pragma once
#include <memory>
#include <vector>

#include "detector/pair_cache.h"

namespace orchard::runtime::detail {

// Fronts for the pairs whose searches cost the most, a bounded number of them. Which pairs get one depends on what they
// were asked and on the order of pairs, never on threads.
class FrontPool {
 public:
  explicit FrontPool(std::size_t most) noexcept : most_(most) {}
  std::size_t most() const noexcept { return most_; }

  // Whether a search of these can be so expensive. A pair has to be counted from the beginning, so that a step that
  // only asks allocates nothing.
  static bool are_large(const TreePair& trees) noexcept;
  void prepare(std::size_t large_pairs);  // with so many there may be as many fronts, up to most()

  // Takes a search's work into account. True: the pair is to have a front.
  static bool wants(CachedPair& record, std::uint64_t work) noexcept;
  // To those records, as far as there are fronts, or fronts of pairs that have not searched for long.
  void give(PairCache& records, std::span<const std::uint32_t> wanting, Step now);
  void give_back(CachedPair& record) noexcept;  // whose pair is no more
  std::size_t memory_bytes() const noexcept {
    return fronts_.size() * sizeof(PairFront) + bytes_of(fronts_) + bytes_of(owners_);
  }

 private:
  std::uint32_t take(PairCache& records, Step now);
  std::size_t most_;
  std::vector<std::unique_ptr<PairFront>> fronts_;
  std::vector<std::uint32_t> owners_;  // records, or kNoOwner
  static constexpr std::uint32_t kNoOwner = 0xffffffffu;
};

}  // namespace orchard::runtime::detail
