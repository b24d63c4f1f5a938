#include "incidence.h"

#include <algorithm>

namespace orchard::detail {

Rows rows_of(const std::vector<std::array<Index, 2>>& pairs, Index count) {
  std::vector<Index> ends(count, 0);  // of the rows, while they are filled; repeated items among them
  for (const auto& pair : pairs) ++ends[pair[0]];
  Index sum = 0;
  for (Index& end : ends) {
    sum += end;
    end = sum - end;
  }
  std::vector<Index> items(pairs.size());
  for (const auto& pair : pairs) items[ends[pair[0]]++] = pair[1];
  Rows result;
  result.offsets.reserve(std::size_t{count} + 1);
  result.items.reserve(items.size());
  auto begin = items.begin();
  for (const Index end : ends) {
    const auto row_end = items.begin() + end;
    std::sort(begin, row_end);
    result.items.insert(result.items.end(), begin, std::unique(begin, row_end));
    result.close_row();
    begin = row_end;
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
