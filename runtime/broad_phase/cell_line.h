#pragma once
#include <bit>
#include <cstring>

#include "broad_phase/swept_grid.h"
#include "simd/vector_support.h"

// What a cell's line has of a body, and how all of a line are compared with a box at once.
namespace orchard::runtime::detail {

// A box clipped to a cell, in three fields each: how far it begins from the cell's lower end, and ends from its upper
// end. As a query these change places: two boxes meet if of each axis one's way to its begin and the other's from its
// end make less than a cell together.
inline constexpr std::uint32_t kEntryBits = 5, kFieldBits = kEntryBits + 1;
inline constexpr std::uint32_t kCoarser = kQuantumBits - kEntryBits;  // bits of a quantum that are left out of entries
inline constexpr std::uint32_t kLastInEntry = (1u << kEntryBits) - 1;
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

ORCHARD_INLINE std::uint64_t entry_of(std::uint64_t from, std::uint64_t below, BodyIndex body) noexcept {
  return std::uint64_t{body} << kIdShift | below << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_from(std::uint64_t entry) noexcept {
  constexpr std::uint64_t field = (std::uint64_t{1} << 3 * kFieldBits) - 1;
  return entry << 3 * kFieldBits | (entry >> 3 * kFieldBits & field);  // above that it does not matter what it has
}
constexpr BodyIndex body_of(std::uint64_t entry) noexcept { return static_cast<BodyIndex>(entry >> kIdShift); }

// For which of a line's entries of(entry) is 0, one bit for each. It gives numbers below 2^kIdShift.
template <typename Of>
ORCHARD_INLINE std::uint64_t zeros(const CellLine& line, const Of& of) noexcept {
  std::uint64_t bits = 0;
#ifdef ORCHARD_VECTORS
  using Words __attribute__((vector_size(32))) = std::uint64_t;
  const auto half = [&](std::size_t at, const Words& as) ORCHARD_INLINE_LAMBDA {
    Words entries;
    std::memcpy(&entries, reinterpret_cast<const char*>(&line) + at, sizeof entries);
    return (of(entries) - 1) & (as << kIdShift);  // of 0 the high bits are set
  };
  const Words all = half(0, Words{1, 2, 4, 8}) | half(32, Words{16, 32, 64, 0});
  const auto both = __builtin_shufflevector(all, all, 0, 1) | __builtin_shufflevector(all, all, 2, 3);
  bits = (both[0] | both[1]) >> kIdShift;
#else
  for (std::uint32_t i = 0; i < kLineRoom; ++i) bits |= std::uint64_t{of(line.entries[i]) == 0} << i;
#endif
  return bits;
}

// Which of a line's entries meet the query: no field of their sum reaches its guard bit, and places without an entry
// are nothing but guard bits.
ORCHARD_INLINE std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
  return zeros(line, [=](const auto& entries) ORCHARD_INLINE_LAMBDA { return (entries + query) & kGuards; });
}
// Which are of the body; of places without an entry that means nothing.
ORCHARD_INLINE std::uint64_t those_of(const CellLine& line, std::uint64_t body) noexcept {
  return zeros(line, [=](const auto& entries) ORCHARD_INLINE_LAMBDA { return (entries >> kIdShift) ^ body; });
}

// 1, and it stays as it is, if it is full; else 0. Without a branch: what has no room is written where the counters
// are, which are written again.
ORCHARD_INLINE std::uint64_t put(CellLine& line, std::uint64_t entry) noexcept {
  static_assert(offsetof(CellLine, count) == sizeof line.entries &&
                offsetof(CellLine, overflow) == offsetof(CellLine, count) + 4);
  auto* const bytes = reinterpret_cast<unsigned char*>(&line);
  std::uint64_t counters;
  std::memcpy(&counters, bytes + sizeof line.entries, sizeof counters);  // the count is its lower half
  const auto count = static_cast<std::uint32_t>(counters);
  const std::uint64_t full = (count + 1) >> 3;
  std::memcpy(bytes + std::size_t{count} * sizeof entry, &entry, sizeof entry);
  counters += full ^ 1;
  std::memcpy(bytes + sizeof line.entries, &counters, sizeof counters);
  return full;
}

// Quanta along the three axes. They are below 2^31, so that two of them are compared at once.
struct Quanta {
  std::uint64_t xy, z;

  static constexpr std::uint64_t kTop = 0x8000000080000000u;
  // The top bits are set where it is at most the other one.
  ORCHARD_INLINE Quanta at_most(const Quanta& other) const noexcept {
    return {(other.xy | kTop) - xy, (other.z | kTop) - z};
  }
  ORCHARD_INLINE static Quanta lower(const PackedAabb& box) noexcept {
    return {box.lower[0] | std::uint64_t{box.lower[1]} << 32, box.lower[2]};
  }
  ORCHARD_INLINE static Quanta upper(const PackedAabb& box) noexcept {
    const Quanta from = lower(box);
    return {from.xy + ((box.lengths & 0xff) | std::uint64_t{box.lengths & 0xff00} << 24), from.z + (box.lengths >> 16)};
  }
};

// A body's box, and one of the cells that it takes: so many steps from its first one along each axis.
class BoxInCell {
 public:
  ORCHARD_INLINE BoxInCell(const PackedAabb& box, std::uint32_t steps) noexcept : lower_(Quanta::lower(box)) {
    const QuantizedAabb whole = box.whole();
    PackedAabb first, last;
    for (std::uint32_t d = 0; d < 3; ++d) {
      const std::uint32_t step = steps >> 2 * d & 3, begin = ((box.lower[d] >> kQuantumBits) + step) << kQuantumBits;
      first.lower[d] = step == 0 ? 0 : begin;  // where the box begins it is the corner of what begins before
      last.lower[d] = std::min(whole.upper[d], begin + (kQuanta - 1));
    }
    first_ = Quanta::lower(first);
    last_ = Quanta::lower(last);
  }
  // Whether the other box meets it, and the lower corner of what they have in common lies in the cell.
  ORCHARD_INLINE bool meets_here(const PackedAabb& other) const noexcept {
    const Quanta from = Quanta::lower(other);
    const Quanta after = first_.at_most(from), before = from.at_most(last_),
                 above = lower_.at_most(Quanta::upper(other));
    return (~(after.xy & before.xy & above.xy & after.z & before.z & above.z) & Quanta::kTop) == 0;
  }

 private:
  Quanta lower_, first_, last_;  // where it begins; where boxes that meet it in the cell begin, at least and at most
};

}  // namespace orchard::runtime::detail
