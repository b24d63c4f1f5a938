#include "least_vertices.h"

#include <vector>

#include "orchard/geometry/disjoint_sets.h"

namespace orchard::detail {
namespace {

// The numbers of pairs and triples of m things.
std::int64_t pairs(std::int64_t m) { return m * (m - 1) / 2; }
std::int64_t triples(std::int64_t m) { return m * (m - 1) * (m - 2) / 6; }

// The largest m with number(m) <= count.
template <class Number>
std::int64_t most_within(std::int64_t count, const Number& number) {
  std::int64_t m = 0;
  while (number(m + 1) <= count) ++m;
  return m;
}

// The least number of edges that so many triangles have (Kruskal and Katona): all triangles of as many corners as
// possible are taken, and the triangles left over share one more corner.
std::int64_t edges_of(std::int64_t triangles) {
  if (triangles == 0) return 0;
  const std::int64_t corners = most_within(triangles, triples);
  const std::int64_t at_next =
      triangles - triples(corners);  // triangles that one more corner forms with edges between these
  if (at_next == 0) return pairs(corners);
  const std::int64_t ends = most_within(at_next, pairs);
  return pairs(corners) + ends + (at_next > pairs(ends) ? 1 : 0);
}

// Divides a mesh into its components.
std::vector<MedialMesh> components_of(const MedialMesh& mesh) {
  DisjointSets joined(mesh.size());
  for (const auto& [a, b] : mesh.edges) joined.unite(a, b);
  std::vector<Index> component(mesh.size(), kNone), number(mesh.size());
  std::vector<MedialMesh> parts;
  for (Index v = 0; v < mesh.size(); ++v) {
    const Index root = joined.root(v);  // the lowest of the component, so met first
    if (root == v) {
      component[v] = static_cast<Index>(parts.size());
      parts.emplace_back();
    }
    component[v] = component[root];
    MedialMesh& part = parts[component[v]];
    number[v] = part.size();
    part.centers.push_back(mesh.centers[v]);
    part.radii.push_back(mesh.radii[v]);
  }
  for (const auto& [a, b] : mesh.edges) parts[component[a]].edges.push_back({number[a], number[b]});
  for (const auto& [a, b, c] : mesh.triangles)
    parts[component[a]].triangles.push_back({number[a], number[b], number[c]});
  return parts;
}

}  // namespace

// One vertex is joined to all others. Among the others there is one triangle for each cavity, and beside the edges of
// these triangles one edge for each loop.
Index least_vertices(std::int64_t loops, std::int64_t cavities) {
  const std::int64_t edges = loops + edges_of(cavities);
  std::int64_t others = 0;
  while (pairs(others) < edges) ++others;
  return static_cast<Index>(1 + others);
}

Index least_vertices(const MedialMesh& mesh) {
  Index sum = 0;
  for (const MedialMesh& part : components_of(mesh)) {
    const Topology found = topology(part);
    sum += least_vertices(found.loops, found.cavities);
  }
  return sum;
}

}  // namespace orchard::detail
