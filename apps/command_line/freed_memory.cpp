#include "command_line/freed_memory.h"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace orchard::apps {

void keep_freed_memory() {
#ifdef __GLIBC__
  // Bytes: larger blocks are mapped on their own and returned to the system when freed; it is the largest value
  // allowed.
  constexpr int kMapped = 32 << 20;
  constexpr int kKept = 256 << 20;  // bytes: free memory above this is returned to the system
  mallopt(M_MMAP_THRESHOLD, kMapped);
  mallopt(M_TRIM_THRESHOLD, kKept);
#endif
}

}  // namespace orchard::apps
