#pragma once
#include <span>
#include <vector>

#include "sheet_extension.h"

namespace orchard::detail {

// The shortest way along old edges, over vertices whose radius is above 0, from any vertex of `from` to any of `to`.
// `length` (mesh units) is the distance of what the two ends belong to: a way that is far longer is not returned, and
// the result is empty.
std::vector<Index> way_between(const SheetExtension& sheets, std::span<const Index> from, std::span<const Index> to,
                               double length);

// Fills the gap between the line from vertex x to vertex y and a way whose ends are joined to x and to y, by triangles:
// a fan around x, a fan around y, and one triangle with both. `is_right(a, b, c)` tells whether a triangle is allowed
// whose side bc is new. Adds nothing unless all are allowed. Returns whether x and y are joined now.
template <class IsRight>
bool fill_between(SheetExtension& sheets, Index x, Index y, std::vector<Index> way, const IsRight& is_right) {
  // Vertices of the way that x or y is joined to already need no fan.
  std::size_t first = 0, last = way.size();
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (sheets.triangles.joined(x, way[i])) first = i;
  }
  for (std::size_t i = way.size(); i > first; --i) {
    if (sheets.triangles.joined(y, way[i - 1])) last = i;
  }
  way.assign(way.begin() + static_cast<std::ptrdiff_t>(first), way.begin() + static_cast<std::ptrdiff_t>(last));
  if (way.empty()) return false;
  const auto apart = [&](Index a, Index b) {
    return (sheets.complex.balls[a].center - sheets.complex.balls[b].center).norm();
  };
  // The fans meet at the vertex of the way that is about as near to x as to y.
  std::size_t meet = 0;
  while (meet + 1 < way.size() && apart(x, way[meet + 1]) < apart(y, way[meet])) ++meet;
  for (std::size_t i = 0; i < meet; ++i) {
    if (!is_right(way[i], x, way[i + 1])) return false;
  }
  for (std::size_t i = way.size() - 1; i > meet; --i) {
    if (!is_right(way[i], y, way[i - 1])) return false;
  }
  if (!is_right(way[meet], x, y)) return false;
  for (std::size_t i = 0; i < meet; ++i) {
    if (!sheets.triangles.add(x, way[i], way[i + 1])) return false;
  }
  for (std::size_t i = way.size() - 1; i > meet; --i) {
    if (!sheets.triangles.add(y, way[i], way[i - 1])) return false;
  }
  return sheets.triangles.add(x, way[meet], y);
}

}  // namespace orchard::detail
