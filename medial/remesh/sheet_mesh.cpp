#include "sheet_mesh.h"

#include <algorithm>

#include "orchard/geometry/disjoint_sets.h"

namespace orchard::detail {
namespace {

constexpr std::uint8_t kUnknown = 255;

bool holds(const SheetMesh::Cell& cell, Index v) { return cell[0] == v || cell[1] == v || cell[2] == v; }

Index other_corner(const SheetMesh::Cell& cell, Index a, Index b) {
  for (const Index v : cell) {
    if (v != a && v != b) return v;
  }
  return kNone;
}

}  // namespace

SheetMesh::SheetMesh(const BallComplex& complex)
    : balls_(complex.balls),
      cells_at_(complex.balls.size()),
      pinned_(complex.balls.size(), 0),
      stratum_(complex.balls.size(), kUnknown) {
  for (const auto& triangle : complex.triangles) add(triangle);
  for (const auto& [a, b] : complex.edges) {
    if (!has_edge(a, b)) add({a, b, b});
  }
  for (Index v = 0; v < vertices(); ++v) {
    if (!has(v)) add({v, v, v});
  }
}

BallComplex SheetMesh::complex() const {
  BallComplex complex;
  std::vector<Index> number(balls_.size(), kNone);
  for (Index v = 0; v < vertices(); ++v) {
    if (!has(v)) continue;
    number[v] = complex.size();
    complex.balls.push_back(balls_[v]);
  }
  for (Index c = 0; c < cells(); ++c) {
    if (!alive(c)) continue;
    const auto& [i, j, k] = cells_[c];
    const Index a = number[i], b = number[j], d = number[k];
    if (is_triangle(cells_[c])) complex.triangles.push_back({a, b, d});
    if (!is_triangle(cells_[c]) && a != b) complex.edges.push_back({a, b});
  }
  complex.complete();
  return complex;
}

Index SheetMesh::add_vertex(const ExactBall& ball) {
  balls_.push_back(ball);
  cells_at_.emplace_back();
  pinned_.push_back(0);
  stratum_.push_back(kUnknown);
  return vertices() - 1;
}

void SheetMesh::pin(Index v) {
  pinned_[v] = 1;
  stratum_[v] = kUnknown;
}

void SheetMesh::enter(Index cell) {
  const Cell& corners = cells_[cell];
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && corners[i] == corners[i - 1]) continue;
    cells_at_[corners[i]].push_back(cell);
    stratum_[corners[i]] = kUnknown;
  }
}

Index SheetMesh::add(const Cell& cell) {
  cells_.push_back(cell);
  enter(cells() - 1);
  return cells() - 1;
}

void SheetMesh::put_back(Index cell, const Cell& corners) {
  cells_[cell] = corners;
  enter(cell);
}

void SheetMesh::take_back(Index first) {
  for (Index cell = first; cell < cells(); ++cell) {
    if (alive(cell)) remove(cell);
  }
  cells_.resize(first);
}

void SheetMesh::remove(Index cell) {
  const Cell corners = cells_[cell];
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && corners[i] == corners[i - 1]) continue;
    std::vector<Index>& at = cells_at_[corners[i]];
    at.erase(std::find(at.begin(), at.end(), cell));
    stratum_[corners[i]] = kUnknown;
  }
  cells_[cell] = {kNone, kNone, kNone};
}

bool SheetMesh::has_edge(Index a, Index b) const {
  return std::any_of(cells_at_[a].begin(), cells_at_[a].end(), [&](Index c) { return holds(cells_[c], b); });
}

void SheetMesh::neighbors(Index v, std::vector<Index>& out) const {
  out.clear();
  for (const Index c : cells_at_[v]) {
    for (const Index other : cells_[c]) {
      if (other != v) out.push_back(other);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

void SheetMesh::neighbors_along(Index v, std::vector<Index>& out) const {
  neighbors(v, out);
  const Stratum own = stratum(v);
  std::erase_if(out, [&](Index other) { return stratum(v, other) != own; });
}

void SheetMesh::opposite(Index a, Index b, std::vector<Index>& out) const {
  out.clear();
  for (const Index c : cells_at_[a]) {
    if (is_triangle(cells_[c]) && holds(cells_[c], b)) out.push_back(other_corner(cells_[c], a, b));
  }
}

std::vector<SheetMesh::Edge> SheetMesh::edges(std::span<const std::uint8_t> of) const {
  std::vector<Edge> edges;
  std::vector<Index> around;
  for (Index v = 0; v < vertices(); ++v) {
    if (!of.empty() && of[v] == 0) continue;
    neighbors(v, around);
    for (auto other = std::upper_bound(around.begin(), around.end(), v); other != around.end(); ++other) {
      if (of.empty() || of[*other] != 0) edges.push_back({v, *other});
    }
  }
  return edges;
}

Stratum SheetMesh::stratum(Index a, Index b) const {
  int triangles = 0;
  for (const Index c : cells_at_[a]) triangles += is_triangle(cells_[c]) && holds(cells_[c], b) ? 1 : 0;
  switch (triangles) {
    case 0:
      return Stratum::curve;
    case 1:
      return Stratum::border;
    case 2:
      return Stratum::sheet;
    default:
      return Stratum::seam;
  }
}

Stratum SheetMesh::stratum(Index v) const {
  if (stratum_[v] == kUnknown) stratum_[v] = static_cast<std::uint8_t>(find_stratum(v));
  return static_cast<Stratum>(stratum_[v]);
}

// The link of the vertex decides: the graph whose nodes are its neighbours and whose edges are the sides of its
// triangles opposite to it.
Stratum SheetMesh::find_stratum(Index v) const {
  if (pinned_[v] != 0 || cells_at_[v].empty()) return Stratum::junction;
  std::vector<Index> around;
  neighbors(v, around);
  const auto number = [&](Index other) {
    return static_cast<Index>(std::lower_bound(around.begin(), around.end(), other) - around.begin());
  };
  std::vector<int> triangles(around.size(), 0);
  DisjointSets joined(static_cast<Index>(around.size()));
  for (const Index c : cells_at_[v]) {
    if (!is_triangle(cells_[c])) continue;
    Index first = kNone;
    for (const Index other : cells_[c]) {
      if (other == v) continue;
      ++triangles[number(other)];
      if (first != kNone) joined.unite(number(first), number(other));
      first = other;
    }
  }
  const auto with = [&](auto&& is) { return std::count_if(triangles.begin(), triangles.end(), is); };
  const auto bare = with([](int n) { return n == 0; }), border = with([](int n) { return n == 1; }),
             seam = with([](int n) { return n >= 3; });
  if (bare == static_cast<std::ptrdiff_t>(around.size())) return bare == 2 ? Stratum::curve : Stratum::junction;
  for (Index i = 1; i < around.size(); ++i) {
    if (joined.root(i) != joined.root(0)) return Stratum::junction;
  }
  if (border == 0 && seam == 0) return Stratum::sheet;
  if (border == 2 && seam == 0) return Stratum::border;
  if (border == 0 && seam == 2) return Stratum::seam;
  return Stratum::junction;
}

bool SheetMesh::contractible(Index a, Index b) const {
  std::vector<Index> near_a, near_b, on_edge;
  neighbors(a, near_a);
  neighbors(b, near_b);
  opposite(a, b, on_edge);
  for (const Index v : near_a) {
    if (v == b || !std::binary_search(near_b.begin(), near_b.end(), v)) continue;
    if (std::find(on_edge.begin(), on_edge.end(), v) == on_edge.end()) return false;
  }
  // No edge may form a triangle with both a and b.
  for (const Index c : cells_at_[a]) {
    if (!is_triangle(cells_[c]) || holds(cells_[c], b)) continue;
    std::array<Index, 2> side{kNone, kNone};
    for (const Index v : cells_[c]) {
      if (v != a) side[side[0] == kNone ? 0 : 1] = v;
    }
    for (const Index other : cells_at_[b]) {
      if (is_triangle(cells_[other]) && holds(cells_[other], side[0]) && holds(cells_[other], side[1])) return false;
    }
  }
  return true;
}

}  // namespace orchard::detail
