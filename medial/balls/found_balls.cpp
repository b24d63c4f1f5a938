#include "found_balls.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace orchard::detail {
namespace {

bool is_same(const ClosestPoint& a, const ClosestPoint& b) {
  return a.position == b.position && a.triangle == b.triangle && a.feature == b.feature;
}

std::uint64_t mixed(std::uint64_t hash, double value) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 29;
}

// Hashes the start only, since few vertices share a place. 0 and -0 have different hashes, which costs no more than
// another search.
std::uint64_t hash_of(const Point& start) { return mixed(mixed(mixed(0, start.x()), start.y()), start.z()); }

}  // namespace

std::span<const ClosestPoint> FoundBalls::seeds_of(Index entry) const {
  const std::size_t begin = entries_[entry].seeds;
  const std::size_t end = entry + 1 < entries_.size() ? entries_[entry + 1].seeds : seeds_.size();
  return std::span(seeds_).subspan(begin, end - begin);
}

std::size_t FoundBalls::place_of(const Point& start, std::span<const ClosestPoint> seeds) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t place = hash_of(start) & mask;
  for (; table_[place] != kNone; place = (place + 1) & mask) {
    const Index entry = table_[place];
    if (entries_[entry].start != start) continue;
    const std::span<const ClosestPoint> known = seeds_of(entry);
    if (std::equal(known.begin(), known.end(), seeds.begin(), seeds.end(), is_same)) break;
  }
  return place;
}

const ExactBall* FoundBalls::find(const Point& start, std::span<const ClosestPoint> seeds) const {
  if (table_.empty()) return nullptr;
  const Index entry = table_[place_of(start, seeds)];
  return entry == kNone ? nullptr : &entries_[entry].ball;
}

void FoundBalls::add(const Point& start, std::span<const ClosestPoint> seeds, const ExactBall& ball) {
  if (2 * (entries_.size() + 1) > table_.size()) grow();
  Index& entry = table_[place_of(start, seeds)];
  if (entry != kNone) return;
  entry = static_cast<Index>(entries_.size());
  entries_.push_back({start, seeds_.size(), ball});
  seeds_.insert(seeds_.end(), seeds.begin(), seeds.end());
}

void FoundBalls::grow() {
  table_.assign(std::max<std::size_t>(1024, 2 * table_.size()), kNone);
  for (Index entry = 0; entry < entries_.size(); ++entry)
    table_[place_of(entries_[entry].start, seeds_of(entry))] = entry;
}

}  // namespace orchard::detail
