#include "detector/pair_cache.h"

#include <cstring>

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

// Of how many pairs the two begin alike: most of them do, from one step to the next.
std::size_t PairCache::common(std::span<const BodyPair> a, std::span<const BodyPair> b) noexcept {
  constexpr std::size_t kAtOnce = 8;
  const std::size_t count = std::min(a.size(), b.size());
  std::size_t i = 0;
  for (; i + kAtOnce <= count; i += kAtOnce) {
    static_assert(sizeof(BodyPair) == sizeof(std::uint64_t));
    std::array<std::uint64_t, kAtOnce> of_a, of_b;
    std::memcpy(of_a.data(), &a[i], sizeof of_a);
    std::memcpy(of_b.data(), &b[i], sizeof of_b);
    std::uint64_t differ = 0;
    for (std::size_t k = 0; k < kAtOnce; ++k) differ |= of_a[k] ^ of_b[k];
    if (differ != 0) break;
  }
  while (i < count && a[i] == b[i]) ++i;
  return i;
}

void PairCache::keep(std::size_t from, std::size_t count) {
  const auto some = [&](const auto& of) { return std::span(of).subspan(from, count); };
  const auto append_some = [](auto& to, const auto& more) { to.insert(to.end(), more.begin(), more.end()); };
  append_some(next_pairs_, some(pairs_));
  append_some(next_slots_, some(slots_));
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
