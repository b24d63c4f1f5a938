#include "command_line/freed_memory.h"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace orchard::apps {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kMapped = 32 << 20;  // bytes: larger blocks are mapped on their own, and given back; the most it takes
  constexpr int kKept = 256 << 20;   // bytes: more than that is given back
  mallopt(M_MMAP_THRESHOLD, kMapped);
  mallopt(M_TRIM_THRESHOLD, kKept);
#endif
}

}  // namespace orchard::apps
