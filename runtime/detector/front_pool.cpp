#include "detector/front_pool.h"

#include <algorithm>

namespace orchard::runtime::detail {
namespace {

// Bringing a front up to date reads some of its 43 KB: a search of fewer tests is better done from scratch. Where every
// pair had one, scenes of small bodies took up to twice as long; from this on they take up to 8 % less.
constexpr std::uint64_t kMinWork = 500;
constexpr std::uint8_t kSearches = 3;   // so expensive ones, more or less in a row
constexpr std::size_t kMinBlocks = 16;  // of eight triangles, that both trees have at least
constexpr Step kIdle = 64;              // steps without being asked, after which another pair may have the front

}  // namespace

bool FrontPool::are_large(const TreePair& trees) noexcept {
  return std::min(trees.a().tree.triangle_blocks.size(), trees.b().tree.triangle_blocks.size()) >= kMinBlocks;
}

void FrontPool::prepare(std::size_t large_pairs) {
  while (fronts_.size() < std::min(large_pairs, most_)) {
    owners_.reserve(fronts_.size() + 1);
    fronts_.push_back(std::make_unique<PairFront>());
    owners_.push_back(kNoOwner);
  }
}

bool FrontPool::wants(CachedPair& record, std::uint64_t work) noexcept {
  if (record.front != kNoFront || !record.large) return false;
  if (work >= kMinWork) {
    record.costly = static_cast<std::uint8_t>(std::min<int>(record.costly + 1, kSearches));
  } else if (work > 0 && record.costly > 0) {
    --record.costly;
  }
  return record.costly >= kSearches;
}

std::uint32_t FrontPool::take(PairCache& records, Step now) {
  const auto unused = std::find(owners_.begin(), owners_.end(), kNoOwner);
  if (unused != owners_.end()) return static_cast<std::uint32_t>(unused - owners_.begin());
  const auto idlest = std::min_element(owners_.begin(), owners_.end(), [&](std::uint32_t p, std::uint32_t q) {
    return records[p].apart_at < records[q].apart_at;
  });
  if (idlest == owners_.end() || records[*idlest].apart_at > now - kIdle) return kNoFront;
  const auto front = static_cast<std::uint32_t>(idlest - owners_.begin());
  give_back(records[*idlest]);
  return front;
}

void FrontPool::give(PairCache& records, std::span<const std::uint32_t> wanting, Step now) {
  for (const std::uint32_t index : wanting) {
    const std::uint32_t front = take(records, now);
    if (front == kNoFront) return;
    owners_[front] = index;
    records[index].front = front;
    records[index].trees.use(fronts_[front].get());
  }
}

void FrontPool::give_back(CachedPair& record) noexcept {
  if (record.front == kNoFront) return;
  owners_[record.front] = kNoOwner;
  record.front = kNoFront;
  record.costly = 0;
  record.trees.use(nullptr);
}

}  // namespace orchard::runtime::detail
