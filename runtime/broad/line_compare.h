#pragma once
#include <bit>
#include <cstring>

#include "../machine.h"
#include "../vector_support.h"
#include "swept_grid.h"

// The seven entries of a cell's line compared at once, for each machine.
namespace orchard::runtime::detail {

inline constexpr std::uint64_t kGuards = 0x820820820u;  // bit 5 of each of six fields

// meeting(): which of a line's entries meet the query, as bits, kSpread of them for each entry. of(): which are of the
// body, one bit for each. Of what is not an entry bits mean nothing.
struct PlainCompare {
  static constexpr int kSpread = 1;
  static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < 7; ++i) {
      bits |= std::uint64_t{((query - line.entries[i]) & kGuards) == kGuards} << i;
    }
    return bits;
  }
  static std::uint64_t of(const CellLine& line, BodyIndex body) noexcept {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < 7; ++i) bits |= std::uint64_t{line.entries[i] >> kIdShift == body} << i;
    return bits;
  }
};

#ifdef ORCHARD_VECTORS
// For machines with vectors of 32 bytes: of twice as many GCC keeps parts in memory.
struct HalvesCompare {
  static constexpr int kSpread = 1;
  using Words __attribute__((vector_size(32))) = std::uint64_t;
  using Two __attribute__((vector_size(16))) = std::uint64_t;
  ORCHARD_INLINE static Words at(const CellLine& line, std::size_t byte) noexcept {
    Words result;
    std::memcpy(&result, reinterpret_cast<const char*>(&line) + byte, sizeof result);
    return result;
  }
  ORCHARD_INLINE static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const Words first = at(line, 0), second = at(line, 32);  // the eighth is the counters
    return bits_of(((query - first) & kGuards) == kGuards, ((query - second) & kGuards) == kGuards);
  }
  ORCHARD_INLINE static std::uint64_t of(const CellLine& line, BodyIndex body) noexcept {
    const std::uint64_t id = body;
    return bits_of(at(line, 0) >> kIdShift == id, at(line, 32) >> kIdShift == id);
  }

 private:
  template <typename Mask>
  ORCHARD_INLINE static std::uint64_t bits_of(const Mask& first, const Mask& second) noexcept {
    const Words met =
        (reinterpret_cast<Words>(first) & Words{1, 2, 4, 8}) | (reinterpret_cast<Words>(second) & Words{16, 32, 64, 0});
    const Two both = __builtin_shufflevector(met, met, 0, 1) | __builtin_shufflevector(met, met, 2, 3);
    return both[0] | both[1];
  }
};

struct WideCompare {
  static constexpr int kSpread = 8;
  using Words __attribute__((vector_size(64))) = std::uint64_t;
  using Bytes __attribute__((vector_size(8))) = std::uint8_t;
  ORCHARD_INLINE static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const Words entries = load<Words>(line);                    // the eighth is the counters
    const auto hit = ((query - entries) & kGuards) == kGuards;  // numbers are spread
    return std::bit_cast<std::uint64_t>(__builtin_convertvector(-hit, Bytes));
  }
  ORCHARD_INLINE static std::uint64_t of(const CellLine& line, BodyIndex body) noexcept {
    return HalvesCompare::of(line, body);
  }
};
#endif

// work.template operator()<Kind>() for the comparison that suits the machine. Without comparisons of 64 bits vectors
// are no faster.
template <typename Work>
void with_best_compare(const Work& work) {
#if defined(ORCHARD_MACHINES)
  const Machine chosen = machine();
  if (chosen == Machine::avx512) {
    return work_with_avx512([&]() ORCHARD_INLINE_LAMBDA { work.template operator()<WideCompare>(); });
  }
  if (chosen == Machine::avx2) {
    return work_with_avx2([&]() ORCHARD_INLINE_LAMBDA { work.template operator()<HalvesCompare>(); });
  }
  work.template operator()<PlainCompare>();
#elif defined(ORCHARD_VECTORS) && defined(__AVX512BW__)
  work.template operator()<WideCompare>();
#elif defined(ORCHARD_VECTORS) && (defined(__AVX2__) || defined(__aarch64__))
  work.template operator()<HalvesCompare>();
#else
  work.template operator()<PlainCompare>();
#endif
}

}  // namespace orchard::runtime::detail
