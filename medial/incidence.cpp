#include "incidence.h"

#include <algorithm>

namespace orchard::detail {

Rows rows_of(std::vector<std::array<Index, 2>>& pairs, Index count) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Rows result;
  auto pair = pairs.begin();
  for (Index row = 0; row < count; ++row) {
    for (; pair != pairs.end() && (*pair)[0] == row; ++pair) result.items.push_back((*pair)[1]);
    result.close_row();
  }
  return result;
}

Index only(std::span<const Index> row, const std::vector<std::uint8_t>& alive) {
  Index found = kNone;
  for (const Index cell : row) {
    if (!alive[cell]) continue;
    if (found != kNone) return kNone;
    found = cell;
  }
  return found;
}

}  // namespace orchard::detail
