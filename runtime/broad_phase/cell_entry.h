#pragma once
#include "broad_phase/swept_grid.h"
#include "simd/vector_support.h"

// What a cell's line has of a body: its box within the cell.
namespace orchard::runtime::detail {

inline constexpr std::uint32_t kEntryBits = 5, kFieldBits = kEntryBits + 1;
inline constexpr std::uint32_t kCoarser = kQuantumBits - kEntryBits;  // bits of a quantum that are left out of entries
inline constexpr std::uint32_t kLastInEntry = (1u << kEntryBits) - 1;
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

// A box clipped to a cell, in three fields each: how far it begins from the cell's lower end, and ends from its upper
// end. As a query these change places: two boxes meet if of each axis one's way to its begin and the other's from its
// end make less than a cell together.
ORCHARD_INLINE std::uint64_t entry_of(std::uint64_t from, std::uint64_t below) noexcept {
  return below << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_from(std::uint64_t entry) noexcept {
  constexpr std::uint64_t field = (std::uint64_t{1} << 3 * kFieldBits) - 1;
  return (entry & field) << 3 * kFieldBits | (entry >> 3 * kFieldBits & field);
}

}  // namespace orchard::runtime::detail
