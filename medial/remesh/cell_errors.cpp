#include "cell_errors.h"

#include <algorithm>

#include "../balls/exact_ball.h"

namespace orchard::detail {

double CellErrors::at(const SheetMesh::Cell& cell, double u, double v, double w, double fine) const {
  const ExactBall &a = mesh_.ball(cell[0]), &b = mesh_.ball(cell[1]), &c = mesh_.ball(cell[2]);
  const double reach =
      std::max({(a.center - b.center).norm(), (b.center - c.center).norm(), (c.center - a.center).norm()});
  return ball_error(surface_, u * a.center + v * b.center + w * c.center, u * a.radius + v * b.radius + w * c.radius,
                    reach, {{&a, u}, {&b, v}, {&c, w}}, fine);
}

double CellErrors::of_cell(const SheetMesh::Cell& cell) const {
  if (!is_triangle(cell)) return cell[0] == cell[1] ? 0 : of_edge(cell[0], cell[1]);
  return std::max({at(cell, 1.0 / 3, 1.0 / 3, 1.0 / 3, fine_), at(cell, 0.5, 0.5, 0, fine_),
                   at(cell, 0, 0.5, 0.5, fine_), at(cell, 0.5, 0, 0.5, fine_)});
}

double CellErrors::of_cells(std::span<const Index> cells, double enough) const {
  double worst = 0;
  for (const Index c : cells) {
    worst = std::max(worst, of_cell(mesh_.corners(c)));
    if (worst > enough) break;
  }
  return worst;
}

double CellErrors::of_cells_at(std::span<const Index> cells, Index v, double enough) {
  double worst = 0;
  ends_.clear();
  for (const Index c : cells) {
    const SheetMesh::Cell& cell = mesh_.corners(c);
    for (const Index other : cell) {
      if (other != v) ends_.push_back(other);
    }
    if (is_triangle(cell)) worst = std::max(worst, at(cell, 1.0 / 3, 1.0 / 3, 1.0 / 3, fine_));
    if (worst > enough) return worst;
  }
  std::sort(ends_.begin(), ends_.end());
  ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
  for (const Index other : ends_) {
    worst = std::max(worst, of_edge(v, other));
    if (worst > enough) return worst;
  }
  return worst;
}

bool CellErrors::leads_outside(Index a, Index b, double limit) const {
  const double radius = 0.5 * (mesh_.ball(a).radius + mesh_.ball(b).radius);
  return radius + surface_.signed_distance(0.5 * (mesh_.center(a) + mesh_.center(b))) > limit;
}

bool CellErrors::crosses_surface(Index a, Index b) const {
  if (!cuts_itself_ || !(mesh_.ball(a).radius > 0) || !(mesh_.ball(b).radius > 0)) return false;
  std::vector<Index> crossed;
  surface_.triangles_overlapping({mesh_.center(a), mesh_.center(b), mesh_.center(b)}, crossed);
  return !crossed.empty();
}

}  // namespace orchard::detail
