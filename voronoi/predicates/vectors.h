#pragma once

// Whether single functions can be compiled for vectors of four doubles and the fused operation (AVX2 and FMA), which
// are called where the machine has them, found when the program runs. ORCHARD_NO_VECTORS leaves them out: so the
// benchmark measures what other machines get.
#if defined(__GNUC__) && defined(__x86_64__) && !defined(ORCHARD_NO_VECTORS)
#define ORCHARD_FOUR_LANES
#endif
