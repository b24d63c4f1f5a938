#pragma once

// Loops over arrays of doubles are compiled a second time for processors with AVX2, by a function that is marked so and
// into which all that it calls in its file is inlined. Both do the same operations in the same order, and the build
// fuses none (-ffp-contract=off), so both give the same bits. The choice is ordinary code: no resolver runs before
// main(), where sanitizers are not ready. Vector types that both share need an alignment that is spelled out: GCC's own
// is 16 bytes for one and 32 for the other.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__AVX2__)
#define ORCHARD_FOR_AVX2 [[gnu::target("avx2"), gnu::flatten]]
#else
#define ORCHARD_FOR_AVX2
#endif

namespace orchard::detail {

// Whether this processor runs what is marked.
inline bool wide() {
#if defined(__x86_64__) && defined(__GNUC__)
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
#else
  return false;
#endif
}

}  // namespace orchard::detail
