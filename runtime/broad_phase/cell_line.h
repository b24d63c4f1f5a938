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

// Returns an entry. `from` has the three fields of the lower ends, `below` those of the upper ends.
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
#if defined(ORCHARD_VECTORS) && defined(__SSE2__)  // one instruction reads the signs of two numbers
  using Two __attribute__((vector_size(16))) = std::uint64_t;
  for (std::size_t i = 0; i < 4; ++i) {
    Two entries;
    std::memcpy(&entries, reinterpret_cast<const char*>(&line) + i * sizeof entries, sizeof entries);
    const Two signs = -of(entries);  // the sign is set unless the value is 0
    bits |= static_cast<std::uint64_t>(_mm_movemask_pd(reinterpret_cast<__m128d>(signs))) << 2 * i;
  }
  bits = ~bits & ((1u << kLineRoom) - 1);
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

// A body's box in one of the cells that it takes. `steps` is how far that cell is from the box's first one, two bits
// for each axis. A pair of boxes is reported in one cell only: the one with the lower corner of their intersection.
// Quanta are below 2^31, so the difference of two has its top bit set if it is negative.
class BoxInCell {
#ifdef ORCHARD_VECTORS
  using Numbers __attribute__((vector_size(16))) = std::uint32_t;
  using Signed __attribute__((vector_size(16))) = std::int32_t;
#else
  using Numbers = std::array<std::uint32_t, 4>;
#endif

 public:
  ORCHARD_INLINE BoxInCell(const PackedAabb& box, std::uint32_t steps) noexcept {
    read(box, lower_, upper_);
    const Numbers further = {steps & 3, steps >> 2 & 3, steps >> 4, 0};
#ifdef ORCHARD_VECTORS
    cell_ = (lower_ >> kQuantumBits) + further;
#else
    for (std::uint32_t d = 0; d < 3; ++d) cell_[d] = (lower_[d] >> kQuantumBits) + further[d];
#endif
  }
  // Returns whether the other box, which has an entry in the cell, meets this one, and the lower corner of their
  // intersection is in the cell.
  ORCHARD_INLINE bool meets_here(const PackedAabb& other) const noexcept {
    Numbers lower{}, upper{};
    read(other, lower, upper);
#ifdef ORCHARD_VECTORS
    using Halves __attribute__((vector_size(16))) = std::uint64_t;
    const auto larger = reinterpret_cast<Signed>(lower_) > reinterpret_cast<Signed>(lower);
    const Numbers corner = larger ? lower_ : lower, apart = (upper_ - lower) | (upper - lower_);
    const auto wrong = reinterpret_cast<Halves>((apart & 0x80000000u) | ((corner >> kQuantumBits) ^ cell_));
    return (wrong[0] | wrong[1]) == 0;
#else
    std::uint32_t apart = 0, elsewhere = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      apart |= (upper_[d] - lower[d]) | (upper[d] - lower_[d]);
      elsewhere |= (std::max(lower_[d], lower[d]) >> kQuantumBits) ^ cell_[d];
    }
    return (apart >> 31 | elsewhere) == 0;
#endif
  }

 private:
  // Unpacks a box. The fourth numbers are 0.
  ORCHARD_INLINE static void read(const PackedAabb& box, Numbers& lower, Numbers& upper) noexcept {
#ifdef ORCHARD_VECTORS
    using Bytes __attribute__((vector_size(16))) = std::uint8_t;
    using Shorts __attribute__((vector_size(16))) = std::uint16_t;
    const auto all = load<Numbers>(box);
    lower = all & Numbers{~0u, ~0u, ~0u, 0};
    // The last four bytes become a number each, in two steps of one instruction each.
    const auto shorts = reinterpret_cast<Shorts>(__builtin_shufflevector(
        reinterpret_cast<Bytes>(all), Bytes{}, 8, 16, 9, 17, 10, 18, 11, 19, 12, 20, 13, 21, 14, 22, 15, 23));
    upper = lower + reinterpret_cast<Numbers>(__builtin_shufflevector(shorts, Shorts{}, 4, 8, 5, 9, 6, 10, 7, 11));
#else
    const QuantizedAabb whole = box.whole();
    for (std::size_t d = 0; d < 3; ++d) lower[d] = whole.lower[d], upper[d] = whole.upper[d];
#endif
  }

  Numbers lower_{}, upper_{}, cell_{};
};

}  // namespace orchard::runtime::detail
