#include "simd/machine.h"

namespace orchard::runtime::detail {

Machine best_machine() noexcept {
#ifdef ORCHARD_MACHINES
  __builtin_cpu_init();  // a query may be asked before main()
  if (!__builtin_cpu_supports("avx2")) return Machine::base;
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return wide ? Machine::avx512 : Machine::avx2;
#else
  return Machine::base;
#endif
}

}  // namespace orchard::runtime::detail
