#pragma once
#include <atomic>
#include <cstdint>

#include "simd/vector_support.h"

// Inner loops are compiled for several machines of one architecture, and the program chooses among them when it runs.
// All do the same operations in the same order and fuse none of them, so all give the same bits. The choice is made in
// ordinary code at the first call. A resolver would run before main(), when neither sanitizers nor other libraries are
// ready.
namespace orchard::runtime::detail {

// The machines. Each has the instructions of those before it. `portable` is the base of the architecture, with the
// loops of one number at a time that other compilers get; tests choose it to compare these loops with the others.
enum class Machine : std::uint8_t { unknown, portable, base, avx2, avx512 };

inline std::atomic<Machine> chosen_machine{Machine::unknown};

Machine best_machine() noexcept;  // the best one that this program is compiled for and this processor has

// Chooses a machine for all threads. This is for tests. Precondition: it is at most best_machine().
inline void use_machine(Machine machine) noexcept { chosen_machine.store(machine, std::memory_order_relaxed); }

inline Machine machine() noexcept {
  const Machine chosen = chosen_machine.load(std::memory_order_relaxed);
  if (chosen != Machine::unknown) [[likely]]
    return chosen;
  const Machine best = best_machine();
  use_machine(best);  // threads that do this at the same time find the same one
  return best;
}

// There is no choice if the whole build is for such a machine anyway, nor on Windows with GCC, whose stack aligns
// vectors of eight to half their size only (bug 54412 of GCC).
#if defined(ORCHARD_VECTORS) && defined(__x86_64__) && !defined(__AVX2__) && !defined(__MINGW32__)
#define ORCHARD_MACHINES 1
#define ORCHARD_FOR_AVX2 __attribute__((target("avx2"), noinline))
#define ORCHARD_FOR_AVX512 __attribute__((target("avx2,avx512f,avx512vl,avx512bw,avx512dq"), noinline))
#endif

// PerMachine<kernel>::call(..) calls kernel(..) as compiled for the chosen machine. The kernel is ORCHARD_INLINE, so it
// becomes part of a function for each machine. `base` does the same for the base of the architecture, if other code is
// better there. `portable` does it one number at a time.
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

// per_machine() does the same for work that uses the private names of a class: per_machine([&]() ORCHARD_INLINE_LAMBDA
// { .. }).
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
