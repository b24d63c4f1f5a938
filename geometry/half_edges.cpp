#include "half_edges.h"

#include <algorithm>
#include <tuple>

namespace orchard {

std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
  const auto for_each_half_edge = [&](const auto& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& corners = mesh.triangles[t];
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax({corners[i], corners[(i + 1) % 3]});
        visit(EdgeUse{low, high, static_cast<Index>(3 * t + i)});
      }
    }
  };
  // A counting sort by the lower vertex leaves buckets that are very small in any ordinary mesh.
  std::vector<std::size_t> ends(mesh.vertices.size() + 1, 0);
  for_each_half_edge([&](const EdgeUse& use) { ++ends[use.low + 1]; });
  for (std::size_t i = 1; i < ends.size(); ++i) ends[i] += ends[i - 1];
  std::vector<EdgeUse> uses(ends.back());
  for_each_half_edge([&](const EdgeUse& use) { uses[ends[use.low]++] = use; });
  std::size_t begin = 0;
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(begin),
              uses.begin() + static_cast<std::ptrdiff_t>(ends[vertex]), [](const EdgeUse& a, const EdgeUse& b) {
                return std::tie(a.high, a.half_edge) < std::tie(b.high, b.half_edge);
              });
    begin = ends[vertex];
  }
  return uses;
}

std::vector<std::array<Index, 3>> triangle_neighbors(const TriangleMesh& mesh) {
  std::vector<std::array<Index, 3>> neighbors(mesh.triangles.size(), {kNone, kNone, kNone});
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) return;
    const Index a = edge[0].half_edge, b = edge[1].half_edge;
    neighbors[a / 3][a % 3] = b / 3;
    neighbors[b / 3][b % 3] = a / 3;
  });
  return neighbors;
}

Rows triangles_around_vertices(const TriangleMesh& mesh) {
  Rows rows;
  rows.offsets.assign(mesh.vertices.size() + 1, 0);
  const auto for_each_corner = [&](const auto& visit) {
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      visit(a, t);
      if (b != a) visit(b, t);
      if (c != a && c != b) visit(c, t);
    }
  };
  for_each_corner([&](Index vertex, Index) { ++rows.offsets[vertex + 1]; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) rows.offsets[v + 1] += rows.offsets[v];
  rows.items.resize(rows.offsets.back());
  std::vector<Index> next(rows.offsets.begin(), rows.offsets.end() - 1);
  for_each_corner([&](Index vertex, Index t) { rows.items[next[vertex]++] = t; });
  return rows;
}

}  // namespace orchard
