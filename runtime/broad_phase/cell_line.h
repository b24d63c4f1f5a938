#pragma once
#include <bit>
#include <cstring>

#include "broad_phase/swept_grid.h"
#include "simd/vector_support.h"

// The entries of the lines of SweptGrid. All entries of a line are compared with a box at the same time.
namespace orchard::runtime::detail {

// An entry is a box clipped to a cell. For each axis, one field has the distance from the cell's lower end to the box's
// lower end, and another field has that from the box's upper end to the cell's upper end. In a query, the two fields
// change places. Two boxes meet if, for each axis and each of the two fields, the sum of entry and query is less than a
// cell.
inline constexpr std::uint32_t kEntryBits = 5, kFieldBits = kEntryBits + 1;
inline constexpr std::uint32_t kCoarser = kQuantumBits - kEntryBits;  // entries are coarser than quanta by these bits
inline constexpr std::uint32_t kLastInEntry = (1u << kEntryBits) - 1;
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

// `from` has the three fields of the lower ends, `below` those of the upper ends.
ORCHARD_INLINE std::uint64_t entry_of(std::uint64_t from, std::uint64_t below, BodyIndex body) noexcept {
  return std::uint64_t{body} << kIdShift | below << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_from(std::uint64_t entry) noexcept {
  constexpr std::uint64_t field = (std::uint64_t{1} << 3 * kFieldBits) - 1;
  return entry << 3 * kFieldBits | (entry >> 3 * kFieldBits & field);  // the bits above all fields are arbitrary
}
constexpr BodyIndex body_of(std::uint64_t entry) noexcept { return static_cast<BodyIndex>(entry >> kIdShift); }

// Returns a bit for each entry of a line: whether of(entry) is 0. The values of of() have to be below 2^kIdShift.
template <typename Of>
ORCHARD_INLINE std::uint64_t zeros(const CellLine& line, const Of& of) noexcept {
  std::uint64_t bits = 0;
#ifdef ORCHARD_VECTORS
  using Words __attribute__((vector_size(32))) = std::uint64_t;
  const auto half = [&](std::size_t at, const Words& as) ORCHARD_INLINE_LAMBDA {
    Words entries;
    std::memcpy(&entries, reinterpret_cast<const char*>(&line) + at, sizeof entries);
    return (of(entries) - 1) & (as << kIdShift);  // the high bits of 0 - 1 are set
  };
  const Words all = half(0, Words{1, 2, 4, 8}) | half(32, Words{16, 32, 64, 0});
  const auto both = __builtin_shufflevector(all, all, 0, 1) | __builtin_shufflevector(all, all, 2, 3);
  bits = (both[0] | both[1]) >> kIdShift;
#else
  for (std::uint32_t i = 0; i < kLineRoom; ++i) bits |= std::uint64_t{of(line.entries[i]) == 0} << i;
#endif
  return bits;
}

// Returns which of a line's entries meet the query: those for which no field of the sum reaches its guard bit. Places
// without an entry have all guard bits set, so they meet nothing.
ORCHARD_INLINE std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
  return zeros(line, [=](const auto& entries) ORCHARD_INLINE_LAMBDA { return (entries + query) & kGuards; });
}
// Returns which entries are of the body. The bits of places without an entry are arbitrary.
ORCHARD_INLINE std::uint64_t those_of(const CellLine& line, std::uint64_t body) noexcept {
  return zeros(line, [=](const auto& entries) ORCHARD_INLINE_LAMBDA { return (entries >> kIdShift) ^ body; });
}

// Adds an entry to a line and returns 0; if the line is full, leaves it as it is and returns 1. It has no branch: an
// entry without room is written over the counters, which are then written again.
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

// Quanta along the three axes. They are below 2^31, so the top bits are free for comparing two of them at the same
// time.
struct Quanta {
  std::uint64_t xy, z;

  static constexpr std::uint64_t kTop = 0x8000000080000000u;
  // Returns top bits that are set for the axes along which this is at most `other`.
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

// A body's box in one of the cells that it takes. `steps` is how far that cell is from the box's first one, two bits
// for each axis. A pair of boxes is reported in one cell only: the one with the lower corner of their intersection.
class BoxInCell {
 public:
  ORCHARD_INLINE BoxInCell(const PackedAabb& box, std::uint32_t steps) noexcept : lower_(Quanta::lower(box)) {
    const QuantizedAabb whole = box.whole();
    PackedAabb first, last;
    for (std::uint32_t d = 0; d < 3; ++d) {
      const std::uint32_t step = steps >> 2 * d & 3, begin = ((box.lower[d] >> kQuantumBits) + step) << kQuantumBits;
      first.lower[d] = step == 0 ? 0 : begin;  // in the box's first cell, the other box may begin before it
      last.lower[d] = std::min(whole.upper[d], begin + (kQuanta - 1));
    }
    first_ = Quanta::lower(first);
    last_ = Quanta::lower(last);
  }
  // Returns whether the other box, which has an entry in the cell, meets this one, and the lower corner of their
  // intersection is in the cell.
  ORCHARD_INLINE bool meets_here(const PackedAabb& other) const noexcept {
    const Quanta from = Quanta::lower(other);
    const Quanta after = first_.at_most(from), before = from.at_most(last_),
                 above = lower_.at_most(Quanta::upper(other));
    return (~(after.xy & before.xy & above.xy & after.z & before.z & above.z) & Quanta::kTop) == 0;
  }

 private:
  Quanta lower_, first_, last_;  // its lower ends; the range of the lower ends of the boxes to report in this cell
};

}  // namespace orchard::runtime::detail
