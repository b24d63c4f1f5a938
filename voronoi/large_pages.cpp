#include "large_pages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>

#include <ctime>
#endif

namespace orchard::detail {

#ifdef MADV_HUGEPAGE
namespace {

constexpr std::uintptr_t kPage = 4096, kLargePage = std::uintptr_t{1} << 21;
constexpr int kMaxSlow = 2;     // large pages that may be slow before small ones take over
constexpr double kSlow = 1e-3;  // longer than small pages in its place would take, in seconds

double seconds_of_thread() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Whether the system maps a large page in no more time than that.
bool maps_quickly(std::uintptr_t page) {
  const double start = seconds_of_thread();
  madvise(reinterpret_cast<void*>(page), kLargePage, MADV_HUGEPAGE);
  *reinterpret_cast<volatile char*>(page) = 0;
  return seconds_of_thread() - start <= kSlow;
}

}  // namespace
#endif

void use_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (first + kPage - 1) & ~(kPage - 1), to = (first + bytes) & ~(kPage - 1);
  int slow = 0;
  for (std::uintptr_t page = (from + kLargePage - 1) & ~(kLargePage - 1); page + kLargePage <= to; page += kLargePage)
    if (!maps_quickly(page) && ++slow == kMaxSlow) return;
#endif
}

}  // namespace orchard::detail
