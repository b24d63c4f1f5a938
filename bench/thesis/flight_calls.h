#pragma once
#include <cstdint>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "rival.h"

namespace orchard::bench {

// What the narrow phase is called with in the flight simulator of 7.2, one steered ship and 10 drones that all have
// this tree's shape: the first `count` calls.
std::vector<Query> flight_calls(const runtime::TreeView& tree, std::size_t count, std::uint64_t seed);

}  // namespace orchard::bench
