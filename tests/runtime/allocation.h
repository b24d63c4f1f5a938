#pragma once
#include <atomic>
#include <cstddef>

// The test program's global allocation functions count their calls and fail on request.
namespace orchard::runtime::test {

extern std::atomic<std::size_t> allocations;  // tests have threads
extern std::atomic<bool> allocation_fails;
extern std::atomic<std::size_t> failing_allocation;  // the one that `allocations` counts as such; 0: none

}  // namespace orchard::runtime::test
