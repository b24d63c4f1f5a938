#pragma once
#include <cstddef>

// The test program's global allocation functions count their calls and fail on request.
namespace orchard::runtime::test {

extern std::size_t allocations;
extern bool allocation_fails;

}  // namespace orchard::runtime::test
