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
constexpr std::uintptr_t kTried = 16;  // small pages that tell how long those of a large page would take
constexpr int kMaxSlow = 2;            // large pages that may take longer before small ones take over

double seconds_of_thread() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// How long writing to some pages takes that are not mapped yet.
double seconds_to_map(std::uintptr_t begin, std::uintptr_t end) {
  const double start = seconds_of_thread();
  for (std::uintptr_t page = begin; page < end; page += kPage) *reinterpret_cast<volatile char*>(page) = 0;
  return seconds_of_thread() - start;
}

double seconds_to_map_large(std::uintptr_t page) {
  const double start = seconds_of_thread();
  madvise(reinterpret_cast<void*>(page), kLargePage, MADV_HUGEPAGE);
  *reinterpret_cast<volatile char*>(page) = 0;
  return seconds_of_thread() - start;
}

}  // namespace
#endif

void use_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  const auto first = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (first + kPage - 1) & ~(kPage - 1), to = (first + bytes) & ~(kPage - 1),
                       from_large = (from + kTried * kPage + kLargePage - 1) & ~(kLargePage - 1);
  if (from_large + kLargePage > to) return;
  const double small = seconds_to_map(from_large - kTried * kPage, from_large) * (kLargePage / (kTried * kPage));
  int slow = 0;
  for (std::uintptr_t page = from_large; page + kLargePage <= to; page += kLargePage)
    if (seconds_to_map_large(page) > small && ++slow == kMaxSlow) return;
#endif
}

}  // namespace orchard::detail
