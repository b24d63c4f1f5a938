#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// Which cells of a complex meet which.
namespace orchard::detail {

// For each of `count` first items, the second ones of its pairs, ascending, each once. O(n) for short rows.
Rows rows_of(const std::vector<std::array<Index, 2>>& pairs, Index count);

// The only living cell of a row; kNone if there is none, or more than one.
Index only(std::span<const Index> row, const std::vector<std::uint8_t>& alive);

}  // namespace orchard::detail
