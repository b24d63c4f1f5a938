#include <algorithm>

#include "remesher.h"

namespace orchard::detail {
namespace {

constexpr double kJoin = 0.5;         // of the target length: edges between junctions that are shorter are collapsed
constexpr double kFairQuality = 0.2;  // the quality that triangles need to keep when an edge is collapsed

double longest_side(const SheetMesh& mesh, std::span<const Index> cells) {
  double longest = 0;
  for (const Index c : cells) {
    const auto& [i, j, k] = mesh.corners(c);
    const Point &a = mesh.center(i), &b = mesh.center(j), &d = mesh.center(k);
    longest = std::max({longest, (a - b).norm(), (b - d).norm(), (a - d).norm()});
  }
  return longest;
}

}  // namespace

void Remesher::collapse_short() {
  std::vector<std::pair<double, Edge>> chosen;  // the edges to collapse, the shortest first
  for (const Edge& edge : open_edges()) {
    const double part = length(edge[0], edge[1]) / target(edge[0], edge[1]);
    if (part < kShort) chosen.push_back({part, edge});
  }
  std::sort(chosen.begin(), chosen.end());
  for (const auto& [part, edge] : chosen) {
    const auto& [a, b] = edge;
    if (!mesh_.has(a) || !mesh_.has(b) || !mesh_.has_edge(a, b)) continue;
    if (length(a, b) < kShort * target(a, b)) collapse(a, b);
  }
}

// Whether a vertex may move along an edge to its other end. It may move within its sheet, or along its seam, border or
// curve, but not off the surface. It may also cross a narrow strip from one border to the other, and move from one
// junction to another one nearby.
bool Remesher::may_go(Index v, Index to) const {
  const Stratum stratum = mesh_.stratum(v), end = mesh_.stratum(to), way = mesh_.stratum(v, to);
  switch (stratum) {
    case Stratum::sheet:
      return true;
    case Stratum::junction:
      return !on_surface(v) && end == Stratum::junction && way != Stratum::sheet &&
             length(v, to) < kJoin * target(v, to);
    case Stratum::border:
      if (end == Stratum::border && way == Stratum::sheet) return !on_surface(v) && !on_surface(to);
      break;
    default:
      break;
  }
  return way == stratum && (end == stratum || end == Stratum::junction) && (!on_surface(v) || on_surface(to));
}

// Whether a vertex may be merged with another one at the same place, whatever kind of edge joins them. The other one
// must not lie in a larger stratum, since that would lose structure.
bool Remesher::may_become(Index v, Index other) const {
  const Stratum stratum = mesh_.stratum(v), end = mesh_.stratum(other);
  return !on_surface(v) && (stratum == Stratum::sheet || end == stratum || end == Stratum::junction);
}

// Vertices at the same place are merged whatever that does to the shape of triangles. This removes the fan of narrow
// sheets in which the wedges between the facets of a round solid meet.
bool Remesher::collapse(Index a, Index b) {
  const bool one_place = is_one_place(length(a, b));
  const bool a_goes = may_go(a, b) || (one_place && may_become(a, b)),
             b_goes = may_go(b, a) || (one_place && may_become(b, a));
  if ((!a_goes && !b_goes) || !mesh_.contractible(a, b)) return false;
  const bool alike = a_goes && b_goes && mesh_.stratum(a) == mesh_.stratum(b) && on_surface(a) == on_surface(b);
  if (alike && !one_place && mesh_.stratum(a) != Stratum::sheet && draw(a, b, middle(a, b))) return true;
  const bool to_a_first = b_goes && contacts_of(a) > contacts_of(b);
  if (to_a_first && draw(b, a, mesh_.ball(a))) return true;
  if (a_goes && draw(a, b, mesh_.ball(b))) return true;
  return b_goes && !to_a_first && draw(b, a, mesh_.ball(a));
}

// Moves vertex a to b, which gets this ball.
bool Remesher::draw(Index a, Index b, const ExactBall& ball) {
  const bool moves = ball.center != mesh_.ball(b).center;
  std::vector<Index> old = cells_at(a);
  if (moves) old.insert(old.end(), mesh_.cells_at(b).begin(), mesh_.cells_at(b).end());
  std::sort(old.begin(), old.end());
  old.erase(std::unique(old.begin(), old.end()), old.end());
  const double length_before = length(a, b), longest = longest_side(mesh_, old);
  const TriangleShape shape = worst_shape(mesh_, old);
  MeshChange change(mesh_, old);
  change.set_ball(b, ball);
  std::vector<Index> touched{b}, flattened;
  for (Cell cell : change.gone()) {
    for (const Index v : cell) {
      if (v != a && v != b) touched.push_back(v);
    }
    const bool at_both =
        std::find(cell.begin(), cell.end(), a) != cell.end() && std::find(cell.begin(), cell.end(), b) != cell.end();
    if (at_both && is_triangle(cell)) flattened.push_back(touched.back());
    if (at_both) continue;
    std::replace(cell.begin(), cell.end(), a, b);
    mesh_.add(cell);
  }
  // Edges without triangles become curves.
  for (const Index v : flattened) {
    if (!mesh_.has_edge(v, b)) mesh_.add({v, b, b});
  }
  if (!mesh_.has(b)) mesh_.add({b, b, b});
  const std::vector<Index> made = change.made();
  const TriangleShape now = worst_shape(mesh_, made);
  if (longest_side(mesh_, made) > std::max(kLong * target_[b], longest)) return false;
  const bool one_place = is_one_place(length_before);
  if (!one_place && (now.quality < std::min(shape.quality, kFairQuality) || !now.flatness.keeps(shape.flatness)))
    return false;
  if (!is_covered(change, made, touched)) return false;
  if (errors_.of_cells_at(made, b, options_.tolerance) > options_.tolerance) return false;
  keep(change, made);
  if (moves) target_[b] = 0.5 * (target_[a] + target_[b]);
  return true;
}

}  // namespace orchard::detail
