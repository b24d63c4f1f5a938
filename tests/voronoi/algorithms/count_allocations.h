#pragma once
#include <cstddef>

namespace orchard::test {

// How often this program has asked for memory so far.
std::size_t allocations();

// Lets the next allocation but `after` fail with std::bad_alloc, once.
void fail_allocation(std::size_t after);
inline constexpr std::size_t kNever = ~std::size_t{0};

}  // namespace orchard::test
