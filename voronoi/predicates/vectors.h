#pragma once

// Whether the compiler can compile single functions for vectors of four doubles and fused operations (AVX2 and FMA).
// The program calls these functions only if it finds, when it runs, that the machine has them. ORCHARD_NO_VECTORS
// leaves them out, so that the benchmark can measure the speed on other machines.
#if defined(__GNUC__) && defined(__x86_64__) && !defined(ORCHARD_NO_VECTORS)
#define ORCHARD_FOUR_LANES
#endif
