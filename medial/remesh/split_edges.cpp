#include <algorithm>

#include "remesher.h"

namespace orchard::detail {

void Remesher::split_long() {
  std::vector<std::pair<double, Edge>> chosen;  // the longest first
  for (const Edge& edge : open_edges()) {
    const double over = length(edge[0], edge[1]) / target(edge[0], edge[1]);
    if (over > kLong) chosen.push_back({-over, edge});
  }
  std::sort(chosen.begin(), chosen.end());
  for (const auto& [over, edge] : chosen) split(edge[0], edge[1]);
}

// Splits the edges whose balls between the ends are off by more than the tolerance, even if they are short enough.
void Remesher::split_wrong() {
  std::vector<std::pair<double, Edge>> chosen;  // the worst first
  for (const Edge& edge : open_edges()) {
    const auto [a, b] = edge;
    if (active_[a] == 0 && active_[b] == 0) continue;
    const double error = errors_.of_edge(a, b);
    if (error <= options_.tolerance || length(a, b) <= options_.min_length || errors_.crosses_surface(a, b)) continue;
    chosen.push_back({-error, edge});
  }
  std::sort(chosen.begin(), chosen.end());
  for (const auto& [error, edge] : chosen) split(edge[0], edge[1]);
}

bool Remesher::split(Index a, Index b) {
  if (!mesh_.has_edge(a, b)) return false;
  if (is_bare(a, b) && errors_.leads_outside(a, b, 2 * options_.tolerance)) return false;
  const ExactBall ball = middle(a, b);
  const std::vector<Index> old = cells_at_edge(a, b);
  const Flatness flatness = worst_flatness(mesh_, old);
  MeshChange change(mesh_, old);
  const Index v = mesh_.add_vertex(ball);
  target_.push_back(0.5 * (target_[a] + target_[b]));
  active_.push_back(1);
  open_.push_back(1);
  for (const Cell& cell : change.gone()) {
    if (!is_triangle(cell)) {
      mesh_.add({a, v, v});
      mesh_.add({v, b, b});
      continue;
    }
    for (const Index end : {a, b}) {
      Cell half = cell;
      std::replace(half.begin(), half.end(), end, v);
      mesh_.add(half);
    }
  }
  const std::vector<Index> made = change.made();
  if (!worst_flatness(mesh_, made).keeps(flatness)) return false;
  if (!is_covered(change, made, std::array{a, b})) return false;
  keep(change, made);
  return true;
}

}  // namespace orchard::detail
