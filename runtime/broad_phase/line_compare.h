#pragma once
#include <bit>
#include <cstring>

#include "broad_phase/swept_grid.h"
#include "simd/machine.h"
#include "simd/vector_support.h"

// The seven entries of a cell's line compared at once, for each machine.
namespace orchard::runtime::detail {

// meeting(): which of a line's entries meet the query, one bit for each: no field of their sum reaches its guard bit,
// and places without an entry are nothing but guard bits. of(): which are of the body, one bit for each; of what is not
// an entry they mean nothing.
struct PlainCompare {
  static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < 7; ++i) bits |= std::uint64_t{((query + line.entries[i]) & kGuards) == 0} << i;
    return bits;
  }
  static std::uint64_t of(const CellLine& line, BodyIndex body) noexcept {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < 7; ++i) bits |= std::uint64_t{line.entries[i] >> kIdShift == body} << i;
    return bits;
  }
};

#ifdef ORCHARD_VECTORS
inline constexpr std::uint64_t kEntriesMask = 0x7f;  // the eighth is the counters

#ifdef __SSE2__
// For any machine with vectors of two numbers of 64 bits, whose signs are one instruction.
struct PairsCompare {
  ORCHARD_INLINE static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const std::uint64_t apart = apart_bits(line, query, 0) | apart_bits(line, query, 1) << 2 |
                                apart_bits(line, query, 2) << 4 | apart_bits(line, query, 3) << 6;
    return ~apart & kEntriesMask;
  }
  ORCHARD_INLINE static std::uint64_t of(const CellLine& line, BodyIndex body) noexcept {
    return PlainCompare::of(line, body);
  }

 private:
  using Two __attribute__((vector_size(16))) = std::uint64_t;
  ORCHARD_INLINE static std::uint64_t apart_bits(const CellLine& line, std::uint64_t query, std::size_t part) noexcept {
    Two entries;
    std::memcpy(&entries, reinterpret_cast<const char*>(&line) + part * sizeof entries, sizeof entries);
    const Two minus = -((query + entries) & kGuards);  // below 0 unless it is 0
    return static_cast<std::uint64_t>(_mm_movemask_pd(reinterpret_cast<__m128d>(minus)));
  }
};
#else
using PairsCompare = PlainCompare;
#endif

// For machines with vectors of 32 bytes: of twice as many GCC keeps parts in memory.
struct HalvesCompare {
  using Words __attribute__((vector_size(32))) = std::uint64_t;
  using Two __attribute__((vector_size(16))) = std::uint64_t;
  ORCHARD_INLINE static Words at(const CellLine& line, std::size_t byte) noexcept {
    Words result;
    std::memcpy(&result, reinterpret_cast<const char*>(&line) + byte, sizeof result);
    return result;
  }
  ORCHARD_INLINE static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const Words first = (query + at(line, 0)) & kGuards, second = (query + at(line, 32)) & kGuards;
#if (defined(ORCHARD_MACHINES) || defined(__AVX2__)) && !defined(__clang__)
    using Doubles __attribute__((vector_size(32))) = double;
    const auto signs = [](const Words& w) ORCHARD_INLINE_LAMBDA {
      return static_cast<std::uint64_t>(__builtin_ia32_movmskpd256(reinterpret_cast<Doubles>(-w)));
    };
    return ~(signs(first) | signs(second) << 4) & kEntriesMask;
#else
    return bits_of(first == 0, second == 0) & kEntriesMask;
#endif
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
  using Words __attribute__((vector_size(64))) = std::uint64_t;
  ORCHARD_INLINE static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const Words sum = query + load<Words>(line);
#ifdef ORCHARD_AVX512_NAMES
    using Signed __attribute__((vector_size(64))) = long long;
    const Words guards = Words{} + kGuards;
    return __builtin_ia32_ptestnmq512(reinterpret_cast<Signed>(sum), reinterpret_cast<Signed>(guards), kEntriesMask);
#else
    const Words bits = reinterpret_cast<Words>((sum & kGuards) == 0) & Words{1, 2, 4, 8, 16, 32, 64, 0};
    using Four __attribute__((vector_size(32))) = std::uint64_t;
    const auto halves = std::bit_cast<std::array<Four, 2>>(bits);
    const Four met = halves[0] | halves[1];
    return (met[0] | met[1]) | (met[2] | met[3]);
#endif
  }
  ORCHARD_INLINE static std::uint64_t of(const CellLine& line, BodyIndex body) noexcept {
    return HalvesCompare::of(line, body);
  }
};
#endif

// work.template operator()<Kind>() for the comparison that suits the machine.
template <typename Work>
void with_best_compare(const Work& work) {
  const Machine chosen = machine();
  if (chosen == Machine::portable) return work.template operator()<PlainCompare>();
#if defined(ORCHARD_MACHINES)
  if (chosen == Machine::avx512) {
    return work_with_avx512([&]() ORCHARD_INLINE_LAMBDA { work.template operator()<WideCompare>(); });
  }
  if (chosen == Machine::avx2) {
    return work_with_avx2([&]() ORCHARD_INLINE_LAMBDA { work.template operator()<HalvesCompare>(); });
  }
  work.template operator()<PairsCompare>();
#elif defined(ORCHARD_VECTORS) && defined(__AVX512BW__)
  work.template operator()<WideCompare>();
#elif defined(ORCHARD_VECTORS) && (defined(__AVX2__) || defined(__aarch64__))
  work.template operator()<HalvesCompare>();
#else
  work.template operator()<PlainCompare>();
#endif
}

}  // namespace orchard::runtime::detail
