#include "voronoi/algorithms/count_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count = 0;
std::atomic<std::size_t> left = orchard::test::kNever;  // until one fails
}  // namespace

// All that pair with each other: the sanitizers bring their own of those that are left out.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++count;
  if (left != orchard::test::kNever && left-- == 0) return nullptr;
  return std::malloc(size);
}
void* operator new(std::size_t size) {
  if (void* room = operator new(size, std::nothrow)) return room;
  throw std::bad_alloc();
}
void operator delete(void* room, const std::nothrow_t&) noexcept { std::free(room); }
void operator delete(void* room) noexcept { std::free(room); }
void operator delete(void* room, std::size_t) noexcept { std::free(room); }

namespace orchard::test {

std::size_t allocations() { return count; }

void fail_allocation(std::size_t after) { left = after; }

}  // namespace orchard::test
