#pragma once
#include <atomic>
#include <cstdint>

#include "simd/vector_support.h"

// Inner loops compiled for several machines of one architecture, and the choice among them when the program runs. All
// do the same operations in the same order and none fuses them, so all give the same bits. The choice is ordinary code,
// made at the first call: no resolver runs before main(), where neither sanitizers nor other libraries are ready.
namespace orchard::runtime::detail {

// Each has what those before it have. `portable` is the base of the architecture, with the loops of one number at a
// time that other compilers get: tests choose it to compare these loops with the others.
enum class Machine : std::uint8_t { unknown, portable, base, avx2, avx512 };

inline std::atomic<Machine> chosen_machine{Machine::unknown};

Machine best_machine() noexcept;  // that this program was compiled for and this processor runs

// From now on, in all threads: for tests. Precondition: at most best_machine().
inline void use_machine(Machine machine) noexcept { chosen_machine.store(machine, std::memory_order_relaxed); }

inline Machine machine() noexcept {
  const Machine chosen = chosen_machine.load(std::memory_order_relaxed);
  if (chosen != Machine::unknown) [[likely]]
    return chosen;
  const Machine best = best_machine();
  use_machine(best);  // threads that come here together find the same
  return best;
}

// Not where the whole build is for such a machine anyway, nor for Windows with GCC, whose stack aligns vectors of eight
// to half their size only (bug 54412 of GCC).
#if defined(ORCHARD_VECTORS) && defined(__x86_64__) && !defined(__AVX2__) && !defined(__MINGW32__)
#define ORCHARD_MACHINES 1
#define ORCHARD_FOR_AVX2 __attribute__((target("avx2"), noinline))
#define ORCHARD_FOR_AVX512 __attribute__((target("avx2,avx512f,avx512vl,avx512bw,avx512dq"), noinline))
#endif

// PerMachine<kernel>::call(..) is kernel(..) for the machine chosen. The kernel is ORCHARD_INLINE, so that it becomes
// part of a function for each.
// `base`: the same for the base of the architecture, where that is better served by other code; `portable`: one number
// at a time.
template <auto kernel, auto base = kernel, auto portable = base>
struct PerMachine;

template <typename Result, typename... Arguments, Result (*kernel)(Arguments...) noexcept,
          Result (*base)(Arguments...) noexcept, Result (*portable)(Arguments...) noexcept>
struct PerMachine<kernel, base, portable> {
#ifdef ORCHARD_MACHINES
  static Result call(Arguments... arguments) noexcept {
    const Machine chosen = machine();
    if (chosen == Machine::avx512) return avx512(arguments...);
    if (chosen == Machine::avx2) return avx2(arguments...);
    if (chosen == Machine::portable) return portable(arguments...);
    return base(arguments...);
  }
  ORCHARD_FOR_AVX2 static Result avx2(Arguments... arguments) noexcept { return kernel(arguments...); }
  ORCHARD_FOR_AVX512 static Result avx512(Arguments... arguments) noexcept { return kernel(arguments...); }
#elif defined(ORCHARD_VECTORS) && !defined(__AVX2__)
  static Result call(Arguments... arguments) noexcept { return base(arguments...); }
#else
  static Result call(Arguments... arguments) noexcept { return kernel(arguments...); }
#endif
};

// The same for work that needs a class's own names: per_machine([&]() ORCHARD_INLINE_LAMBDA { .. }).
#ifdef ORCHARD_MACHINES
template <typename Work>
ORCHARD_FOR_AVX2 void work_with_avx2(const Work& work) {
  work();
}
template <typename Work>
ORCHARD_FOR_AVX512 void work_with_avx512(const Work& work) {
  work();
}
#endif
template <typename Work>
void per_machine(const Work& work) {
#ifdef ORCHARD_MACHINES
  const Machine chosen = machine();
  if (chosen == Machine::avx512) return work_with_avx512(work);
  if (chosen == Machine::avx2) return work_with_avx2(work);
#endif
  work();
}

}  // namespace orchard::runtime::detail
