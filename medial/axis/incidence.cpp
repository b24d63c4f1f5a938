#include "incidence.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace orchard::detail {
namespace {

constexpr Index kShortRow = 16;

std::vector<Index> with_cells(const Rows& rows, std::size_t count) {
  std::vector<Index> found;
  for (Index i = 0; i < rows.size(); ++i) {
    if (rows[i].size() == count) found.push_back(i);
  }
  return found;
}

// For each first corner (there are `count`), where its cells start in a list that is sorted by first corners.
template <class Cell>
std::vector<Index> starts_of(const std::vector<Cell>& cells, Index count) {
  std::vector<Index> starts(count, 0);
  for (const Cell& cell : cells) ++starts[cell[0]];
  std::exclusive_scan(starts.begin(), starts.end(), starts.begin(), Index{0});
  return starts;
}

// Sorts cells by a counting sort on the first corner, then each group of cells, which is small, on its own.
template <class Cell>
void sort_and_deduplicate(std::vector<Cell>& cells) {
  Index count = 0;
  for (Cell& corners : cells) {
    std::sort(corners.begin(), corners.end());
    count = std::max(count, corners[0] + 1);
  }
  std::vector<Index> end = starts_of(cells, count);  // while they are filled
  std::vector<Cell> sorted(cells.size());
  for (const Cell& corners : cells) sorted[end[corners[0]]++] = corners;
  auto begin = sorted.begin();
  for (const Index e : end) {
    std::sort(begin, sorted.begin() + e);
    begin = sorted.begin() + e;
  }
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  cells = std::move(sorted);
}

// Adds those of `more` that are not among the cells yet. Both are sorted.
template <class Cell>
void merge_sorted(std::vector<Cell>& cells, const std::vector<Cell>& more) {
  if (more.empty()) return;
  std::vector<Cell> all;
  all.reserve(cells.size() + more.size());
  std::set_union(cells.begin(), cells.end(), more.begin(), more.end(), std::back_inserter(all));
  cells = std::move(all);
}

// Rows filled by for_each(), which calls its argument with (row, item). In each row the items must come ascending and
// without repetition. for_each() is called twice: to count and to fill.
template <class ForEach>
Rows rows_of_ascending(Index count, const ForEach& for_each) {
  Rows rows;
  rows.offsets.assign(std::size_t{count} + 2, 0);  // one on, so that filling moves starts to ends
  for_each([&](Index row, Index) { ++rows.offsets[row + 2]; });
  std::partial_sum(rows.offsets.begin(), rows.offsets.end(), rows.offsets.begin());
  rows.items.resize(rows.offsets.back());
  for_each([&](Index row, Index item) { rows.items[rows.offsets[row + 1]++] = item; });
  rows.offsets.pop_back();
  return rows;
}

}  // namespace

Rows rows_of(const std::vector<std::array<Index, 2>>& pairs, Index count) {
  std::vector<Index> ends = starts_of(pairs, count);  // of the rows, while they are filled; repeated items among them
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

void complete_cells(std::vector<std::array<Index, 2>>& edges, std::vector<std::array<Index, 3>>& triangles) {
  for (const auto& [a, b, c] : triangles) {
    edges.push_back({a, b});
    edges.push_back({a, c});
    edges.push_back({b, c});
  }
  sort_and_deduplicate(edges);
  sort_and_deduplicate(triangles);
}

void insert_cells(std::vector<std::array<Index, 2>>& edges, std::vector<std::array<Index, 3>>& triangles,
                  std::vector<std::array<Index, 2>> more_edges, std::vector<std::array<Index, 3>> more_triangles) {
  complete_cells(more_edges, more_triangles);
  merge_sorted(edges, more_edges);
  merge_sorted(triangles, more_triangles);
}

EdgeNumbers::EdgeNumbers(const std::vector<std::array<Index, 2>>& edges, Index vertices)
    : edges_(edges), begin_(std::size_t{vertices} + 1, 0) {
  for (const auto& [a, b] : edges) ++begin_[a + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
}

// In a short row it is faster to count the edges before the one that is sought than to bisect, whose branches the
// processor cannot predict.
Index EdgeNumbers::operator()(Index a, Index b) const {
  const Index low = std::min(a, b), high = std::max(a, b);
  const Index begin = begin_[low], end = begin_[low + 1];
  const auto is_before = [&](const std::array<Index, 2>& edge) { return edge[1] < high; };
  if (end - begin > kShortRow) {
    const auto found = std::partition_point(edges_.begin() + begin, edges_.begin() + end, is_before);
    return static_cast<Index>(found - edges_.begin());
  }
  Index e = begin;
  for (Index i = begin; i < end; ++i) e += is_before(edges_[i]) ? 1 : 0;
  return e;
}

CellIncidence::CellIncidence(const std::vector<std::array<Index, 2>>& edges,
                             const std::vector<std::array<Index, 3>>& triangles, Index vertices) {
  const EdgeNumbers edge(edges, vertices);
  sides.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) sides.push_back({edge(a, b), edge(a, c), edge(b, c)});
  triangles_at = rows_of_ascending(static_cast<Index>(edges.size()), [&](const auto& add) {
    for (Index t = 0; t < sides.size(); ++t) {
      const auto& [ab, ac, bc] = sides[t];
      add(ab, t);
      if (ac != ab) add(ac, t);
      if (bc != ab && bc != ac) add(bc, t);
    }
  });
  edges_at = rows_of_ascending(vertices, [&](const auto& add) {
    for (Index e = 0; e < edges.size(); ++e) {
      const auto& [a, b] = edges[e];
      add(a, e);
      if (b != a) add(b, e);
    }
  });
}

std::vector<Index> CellIncidence::border_edges() const { return with_cells(triangles_at, 1); }
std::vector<Index> CellIncidence::bare_edges() const { return with_cells(triangles_at, 0); }
std::vector<Index> CellIncidence::lone_vertices() const { return with_cells(edges_at, 0); }

}  // namespace orchard::detail
