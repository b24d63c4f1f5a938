#include "neck_test.h"

#include <algorithm>
#include <utility>

namespace orchard::detail {
namespace {

void sort_each_once(std::vector<Index>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

NeckFault find_neck(const RestrictedVoronoi& restricted, const CellPatch& patch) {
  NeckFault fault;
  std::vector<std::array<Index, 2>> junctions;
  std::vector<Index> ends;  // of the arcs shared with other cells; an arc has two at most
  for (const Index triangle : patch.triangles) {
    const CellPiece& piece = *restricted.piece(triangle, patch.cell);
    fault.neighbors.insert(fault.neighbors.end(), piece.borders.begin(), piece.borders.end());
    for (const auto& others : piece.junctions) {
      if (others[0] > patch.cell) junctions.push_back(others);
      for (const Index other : others) {
        if (other > patch.cell) ends.push_back(other);
      }
    }
  }
  sort_each_once(fault.neighbors);
  // Fewer than three neighbours: two or three cells share a closed surface, however their borders run.
  fault.found = patch.euler_characteristic != 1 || fault.neighbors.size() < 3;
  if (fault.found) return fault;
  fault.neighbors.clear();
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 2; i < ends.size(); ++i) {
    if (ends[i] == ends[i - 2]) fault.neighbors.push_back(ends[i]);
  }
  std::sort(junctions.begin(), junctions.end());
  for (std::size_t i = 1; i < junctions.size(); ++i) {
    if (junctions[i] == junctions[i - 1]) {
      fault.neighbors.insert(fault.neighbors.end(), junctions[i].begin(), junctions[i].end());
    }
  }
  sort_each_once(fault.neighbors);
  fault.found = !fault.neighbors.empty();
  return fault;
}

std::pair<Point, Index> farthest_corner(const RestrictedVoronoi& restricted, const CellPatch& patch, Index neighbor) {
  std::pair<Point, Index> farthest{Point::Zero(), kNone};
  double squared = -1;
  CellPolygon polygon;
  for (const Index triangle : patch.triangles) {
    restricted.polygon(triangle, patch.cell, polygon);
    const std::size_t size = polygon.corners.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Index before = polygon.labels[i == 0 ? size - 1 : i - 1], after = polygon.labels[i];
      if (neighbor != kNone && before != neighbor + 3 && after != neighbor + 3) continue;
      const double candidate = (polygon.corners[i] - restricted.points()[patch.cell]).squaredNorm();
      if (candidate <= squared) continue;
      squared = candidate;
      farthest = {polygon.corners[i], triangle};
    }
  }
  return farthest;
}

}  // namespace orchard::detail
