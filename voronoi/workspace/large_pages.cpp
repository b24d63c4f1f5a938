#include "workspace/large_pages.h"

#include <memory>

#ifdef __linux__
#include <sys/mman.h>

#include <ctime>
#endif

namespace orchard::detail {

#ifdef MADV_HUGEPAGE
namespace {

constexpr std::size_t kPage = 4096, kLargePage = std::size_t{1} << 21;
constexpr std::size_t kTried = 16;  // small pages that tell how long those of a large page would take
constexpr int kMaxSlow = 2;         // large pages that may take longer before small ones take over

double seconds_of_thread() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void write_to(char* page) { *static_cast<volatile char*>(page) = 0; }

// The time of the first write to each of these pages, which are not mapped before.
double seconds_to_map(char* begin, const char* end) {
  const double start = seconds_of_thread();
  for (char* page = begin; page < end; page += kPage) write_to(page);
  return seconds_of_thread() - start;
}

double seconds_to_map_large(char* page) {
  const double start = seconds_of_thread();
  madvise(page, kLargePage, MADV_HUGEPAGE);
  write_to(page);
  return seconds_of_thread() - start;
}

}  // namespace
#endif

void use_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kTriedBytes = kTried * kPage;
  constexpr double kTimes = static_cast<double>(kLargePage) / static_cast<double>(kTriedBytes);
  if (bytes < kTriedBytes + kPage) return;
  auto* const first = static_cast<char*>(begin);
  // The first large page that leaves room before it for the small pages whose time is taken.
  void* aligned = first + kTriedBytes + kPage;
  std::size_t left = bytes - kTriedBytes - kPage;
  if (std::align(kLargePage, kLargePage, aligned, left) == nullptr) return;
  auto* page = static_cast<char*>(aligned);
  const double small = kTimes * seconds_to_map(page - kTriedBytes, page);
  int slow = 0;
  for (; left >= kLargePage; page += kLargePage, left -= kLargePage)
    if (seconds_to_map_large(page) > small && ++slow == kMaxSlow) return;
#endif
}

}  // namespace orchard::detail
