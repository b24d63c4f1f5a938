#include "detector/pair_cache.h"

namespace orchard::runtime::detail {

void PairCache::take(std::size_t place) {
  if (free_.empty()) {
    records_.push_back(std::make_unique<CachedPair>());
    free_.reserve(records_.capacity());
    known(place).record = static_cast<std::uint32_t>(records_.size() - 1);
  } else {
    known(place).record = free_.back();
    free_.pop_back();
    *records_[known(place).record] = {};
  }
}

void PairCache::keep(std::size_t from, std::size_t count) {
  const auto at = static_cast<std::ptrdiff_t>(from), end = static_cast<std::ptrdiff_t>(from + count);
  next_pairs_.insert(next_pairs_.end(), pairs_.begin() + at, pairs_.begin() + end);
  next_slots_.insert(next_slots_.end(), slots_.begin() + at, slots_.begin() + end);
}

void PairCache::add(const BodyPair& pair, std::uint32_t generations) {
  std::uint32_t slot = static_cast<std::uint32_t>(known_.size());
  if (free_slots_.empty()) {
    known_.emplace_back();
    free_slots_.reserve(known_.capacity());
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  Known& known = known_[slot];
  known.pair = pair;
  known.record = kNoRecord;
  known.generations = generations;
  known.clearance.distance = 0;
  next_pairs_.push_back(pair);
  next_slots_.push_back(slot);
}

void PairCache::leave(std::size_t place) noexcept {
  const std::uint32_t slot = slots_[place] & kSlot;
  if (known_[slot].record != kNoRecord) free_.push_back(known_[slot].record);
  free_slots_.push_back(slot);
}

}  // namespace orchard::runtime::detail
