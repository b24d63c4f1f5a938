#pragma once

// Loops over arrays of doubles are compiled a second time for processors with AVX2. A function that is marked for that
// inlines everything that it calls in its file. Both versions do the same operations in the same order, and the build
// does not fuse any (-ffp-contract=off), so both give the same bits. The choice is made by ordinary code, because a
// resolver would run before main(), when sanitizers are not ready. Vector types that both versions share need an
// explicit alignment: GCC's own is 16 bytes in one and 32 in the other.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__AVX2__)
#define ORCHARD_FOR_AVX2 [[gnu::target("avx2"), gnu::flatten]]
#else
#define ORCHARD_FOR_AVX2
#endif

namespace orchard::detail {

// Whether this processor can run the code that is marked.
inline bool wide() {
#if defined(__x86_64__) && defined(__GNUC__)
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
#else
  return false;
#endif
}

}  // namespace orchard::detail
