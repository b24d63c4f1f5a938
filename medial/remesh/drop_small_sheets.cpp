#include <algorithm>
#include <map>
#include <numbers>

#include "orchard/geometry/angle.h"
#include "orchard/geometry/disjoint_sets.h"
#include "remesher.h"

namespace orchard::detail {
namespace {

constexpr double kSmallSheet = 1;  // of the largest radius of a sheet: sheets with a smaller box are removed
constexpr std::size_t kFew = 3;    // sheets with at most so many triangles are removed, too
// The angle of a triangle with one neighbour below which it counts as protruding from the border.
constexpr double kEar = 100 * std::numbers::pi / 180;

bool is_ear(const SheetMesh& mesh, const SheetMesh::Cell& cell, Index v) {
  std::array<Point, 2> ends{Point::Zero(), Point::Zero()};
  std::size_t n = 0;
  for (const Index other : cell) {
    if (other != v) ends[n++] = mesh.center(other);
  }
  return angle_between(ends[0] - mesh.center(v), ends[1] - mesh.center(v)) < kEar;
}

double size_of(const SheetMesh& mesh, const std::vector<Index>& cells, double& largest_radius) {
  Box box;
  for (const Index c : cells) {
    for (const Index v : mesh.corners(c)) {
      largest_radius = std::max(largest_radius, mesh.ball(v).radius);
      box.extend(mesh.center(v));
    }
  }
  return box.diagonal().norm();
}

// Finds an order in which triangles can be removed one by one, each from a free side, so that the topology stays. It
// tells whether there is one, and which sides of the triangles are then without a triangle, except for the free ones.
class Unwrapping {
 public:
  template <class TrianglesAt>
  Unwrapping(const SheetMesh& mesh, std::vector<Index> cells, const TrianglesAt& triangles_at) {
    for (const Index c : cells) {
      for (const auto& side : sides(mesh.corners(c))) left_.try_emplace(side, triangles_at(side));
    }
    for (bool found = true; found && !cells.empty();) {
      found = false;
      std::erase_if(cells, [&](Index c) {
        const auto own = sides(mesh.corners(c));
        const auto free = std::find_if(own.begin(), own.end(), [&](const auto& side) { return left_[side] == 1; });
        if (free == own.end()) return false;
        for (const auto& side : own) --left_[side];
        left_[*free] = -1;
        return found = true;
      });
    }
    complete_ = cells.empty();
  }
  bool complete() const { return complete_; }
  std::vector<SheetMesh::Edge> bare() const {
    std::vector<SheetMesh::Edge> edges;
    for (const auto& [side, triangles] : left_) {
      if (triangles == 0) edges.push_back(side);
    }
    return edges;
  }

 private:
  static std::array<SheetMesh::Edge, 3> sides(const SheetMesh::Cell& cell) {
    const auto edge = [](Index a, Index b) { return SheetMesh::Edge{std::min(a, b), std::max(a, b)}; };
    return {edge(cell[0], cell[1]), edge(cell[1], cell[2]), edge(cell[2], cell[0])};
  }
  std::map<SheetMesh::Edge, int> left_;  // the number of triangles at each side, and -1 after the side has been removed
  bool complete_ = false;
};

}  // namespace

// Removes sheets that are small compared with their balls, the smallest first, if the rest covers what they cover.
void Remesher::drop_small_sheets() {
  DisjointSets sheet(mesh_.cells());
  for (const auto& [a, b] : mesh_.edges()) {
    if (mesh_.stratum(a, b) != Stratum::sheet) continue;
    const std::vector<Index> cells = cells_at_edge(a, b);
    sheet.unite(cells[0], cells[1]);
  }
  std::map<Index, std::vector<Index>> triangles;
  for (Index c = 0; c < mesh_.cells(); ++c) {
    if (mesh_.alive(c) && is_triangle(mesh_.corners(c))) triangles[sheet.root(c)].push_back(c);
  }
  std::vector<std::pair<double, Index>> small;
  for (const auto& [root, cells] : triangles) {
    if (!std::all_of(cells.begin(), cells.end(), [&](Index c) { return is_open(mesh_.corners(c)); })) continue;
    double largest = 0;
    const double size = size_of(mesh_, cells, largest);
    if (size < kSmallSheet * largest || cells.size() <= kFew) small.emplace_back(size, root);
  }
  std::sort(small.begin(), small.end());
  for (const auto& [size, root] : small) drop(triangles[root]);
}

// Removes triangles that protrude from borders, and ends of curves, if the rest covers what they cover.
void Remesher::trim() {
  for (Index c = 0; c < mesh_.cells(); ++c) {
    if (!mesh_.alive(c)) continue;
    const Cell cell = mesh_.corners(c);
    if (cell[0] == cell[1] || !is_open(cell)) continue;
    if (!is_triangle(cell)) {
      drop_end(c);
      continue;
    }
    const bool sticks_out = std::any_of(
        cell.begin(), cell.end(), [&](Index v) { return mesh_.cells_at(v).size() == 1 && is_ear(mesh_, cell, v); });
    if (sticks_out) drop({c});
  }
}

// Removes triangles. Their edges without triangles become curves, and those that dangle are removed, too. Corners of
// the surface that the axis reaches stay reached.
bool Remesher::drop(const std::vector<Index>& triangles) {
  const Unwrapping unwrapping(
      mesh_, triangles, [&](const Edge& side) { return static_cast<int>(cells_at_edge(side[0], side[1]).size()); });
  if (!unwrapping.complete()) return false;
  std::vector<Index> touched, corners;
  for (const Index c : triangles) {
    for (const Index v : mesh_.corners(c)) touched.push_back(v);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const Index v : touched) {
    if (on_surface(v) && mesh_.stratum(v) == Stratum::junction) corners.push_back(v);
  }
  MeshChange change(mesh_, triangles);
  for (const auto& [a, b] : unwrapping.bare()) mesh_.add({a, b, b});
  drop_dangling(change.first_made());
  if (!std::all_of(corners.begin(), corners.end(), [&](Index v) { return mesh_.has(v); })) return false;
  const std::vector<Index> made = change.made();
  if (errors_.of_cells(made, options_.tolerance) > options_.tolerance || !is_covered(change, made, touched))
    return false;
  keep(change, made);
  return true;
}

// Removes bare edges from number `first` on that have a free end.
void Remesher::drop_dangling(Index first) {
  for (bool found = true; found;) {
    found = false;
    for (Index c = first; c < mesh_.cells(); ++c) {
      if (!mesh_.alive(c)) continue;
      const Cell cell = mesh_.corners(c);
      if ((mesh_.cells_at(cell[0]).size() == 1) == (mesh_.cells_at(cell[1]).size() == 1)) continue;
      mesh_.remove(c);
      found = true;
    }
  }
}

// Removes the last edge of a curve that ends freely.
bool Remesher::drop_end(Index edge) {
  const Cell cell = mesh_.corners(edge);
  const bool first_free = mesh_.cells_at(cell[0]).size() == 1, second_free = mesh_.cells_at(cell[1]).size() == 1;
  if (first_free == second_free) return false;
  const Index stays = first_free ? cell[1] : cell[0];
  MeshChange change(mesh_, {edge});
  if (!is_covered(change, {}, std::array{stays})) return false;
  keep(change, {});
  active_[stays] = 1;
  return true;
}

}  // namespace orchard::detail
