#include <algorithm>
#include <limits>

#include "remesher.h"

namespace orchard::detail {

void Remesher::flip() {
  for (const auto& [a, b] : open_edges()) flip(a, b);
}

bool Remesher::flip(Index a, Index b) {
  if (!mesh_.has_edge(a, b) || mesh_.stratum(a, b) != Stratum::sheet) return false;
  std::vector<Index> opposite;
  mesh_.opposite(a, b, opposite);
  const Index c = opposite[0], d = opposite[1];
  if (mesh_.has_edge(c, d)) return false;
  const std::vector<Index> old = cells_at_edge(a, b);
  const double quality = std::min(triangle_quality(mesh_.center(a), mesh_.center(c), mesh_.center(d)),
                                  triangle_quality(mesh_.center(b), mesh_.center(c), mesh_.center(d)));
  if (!(quality > worst_quality(mesh_, old))) return false;
  const Flatness flatness = worst_flatness(mesh_, old);
  const double allowed = std::max(options_.tolerance, errors_.of_cells(old, std::numeric_limits<double>::infinity()));
  MeshChange change(mesh_, old);
  mesh_.add({a, c, d});
  mesh_.add({b, c, d});
  const std::vector<Index> made = change.made();
  if (!worst_flatness(mesh_, made).keeps(flatness) || errors_.of_cells(made, allowed) > allowed) return false;
  if (!is_covered(change, made, std::array{a, b, c, d})) return false;
  keep(change, made);
  return true;
}

}  // namespace orchard::detail
