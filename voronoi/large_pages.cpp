#include "large_pages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace orchard::detail {

void use_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPage = 4096, kLargePage = std::uintptr_t{1} << 21;
  constexpr std::uintptr_t kWorth = 2 * kLargePage;  // less may lie on one of them, most of which would stay empty
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (first + kPage - 1) & ~(kPage - 1), to = (first + bytes) & ~(kPage - 1);
  if (to >= from + kWorth) madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

}  // namespace orchard::detail
