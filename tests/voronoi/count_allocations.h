#pragma once
#include <cstddef>

namespace orchard::test {

// How often this program has asked for memory so far.
std::size_t allocations();

}  // namespace orchard::test
