#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/random.h"

namespace orchard {
namespace {

using Edge = std::array<Index, 2>;
using Triangle = std::array<Index, 3>;

using EdgeUses = std::map<std::set<Index>, std::vector<std::pair<Index, Edge>>>;  // triangles, and how they run

// Pieces of a set of triangles that edges through `vertex` (any edges for kNone) hold together.
Index pieces(const EdgeUses& edges, std::set<Index> triangles, Index vertex) {
  Index number = 0;
  for (; !triangles.empty(); ++number) {
    std::vector<Index> stack{*triangles.begin()};
    triangles.erase(triangles.begin());
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (const auto& [key, uses] : edges) {
        if (vertex != kNone && !key.contains(vertex)) continue;
        if (std::ranges::none_of(uses, [&](const auto& use) { return use.first == t; })) continue;
        for (const auto& use : uses) {
          if (triangles.erase(use.first)) stack.push_back(use.first);
        }
      }
    }
  }
  return number;
}

// Everything that MeshReport says about connectivity, by sets and searches that follow the definitions.
MeshReport brute_force(const TriangleMesh& mesh) {
  MeshReport report;
  const Index count = static_cast<Index>(mesh.triangles.size());
  const auto collapsed = [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  EdgeUses edges;
  std::vector<std::set<Index>> order;  // as first met
  std::set<Index> used, joined;
  for (Index t = 0; t < count; ++t) {
    used.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    if (collapsed(mesh.triangles[t])) continue;
    ++report.euler_characteristic;
    joined.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge{mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]};
      auto& uses = edges[{edge[0], edge[1]}];
      if (uses.empty()) order.push_back({edge[0], edge[1]});
      uses.push_back({t, edge});
    }
  }
  report.euler_characteristic += static_cast<std::int64_t>(joined.size()) - static_cast<std::int64_t>(edges.size());
  report.unused_vertices = static_cast<Index>(mesh.vertices.size() - used.size());
  const auto tally = [](Index& number, Edge& first, const Edge& edge) {
    if (number++ == 0) first = edge;
  };
  for (const auto& key : order) {
    const auto& uses = edges[key];
    if (uses.size() == 1) tally(report.boundary_edges, report.first_boundary_edge, uses[0].second);
    if (uses.size() > 2) tally(report.non_manifold_edges, report.first_non_manifold_edge, uses[0].second);
    if (uses.size() == 2 && uses[0].second == uses[1].second) {
      tally(report.misoriented_edges, report.first_misoriented_edge, uses[0].second);
    }
  }
  std::set<Index> all;
  std::map<Index, std::set<Index>> around;
  for (Index t = 0; t < count; ++t) {
    if (collapsed(mesh.triangles[t])) continue;
    all.insert(t);
    for (const Index corner : mesh.triangles[t]) around[corner].insert(t);
  }
  report.components = pieces(edges, all, kNone);
  for (const auto& [vertex, triangles] : around) {
    if (pieces(edges, triangles, vertex) > 1 && report.non_manifold_vertices++ == 0)
      report.first_non_manifold_vertex = vertex;
  }
  return report;
}

TEST(MeshCheck, AgreesWithBruteForceOnRandomTriangles) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 1);
    TriangleMesh mesh;
    const Index vertices = 3 + static_cast<Index>(random.below(8));
    for (Index i = 0; i < vertices; ++i) {
      mesh.vertices.emplace_back(random.uniform(), random.uniform(), random.uniform());
    }
    for (std::uint64_t i = 1 + random.below(20); i > 0; --i) {
      Triangle& triangle = mesh.triangles.emplace_back();
      for (Index& corner : triangle) corner = static_cast<Index>(random.below(vertices));
    }
    const MeshReport report = check_mesh(mesh), expected = brute_force(mesh);
    EXPECT_EQ(report.components, expected.components);
    EXPECT_EQ(report.euler_characteristic, expected.euler_characteristic);
    EXPECT_EQ(report.boundary_edges, expected.boundary_edges);
    EXPECT_EQ(report.first_boundary_edge, expected.first_boundary_edge);
    EXPECT_EQ(report.non_manifold_edges, expected.non_manifold_edges);
    EXPECT_EQ(report.first_non_manifold_edge, expected.first_non_manifold_edge);
    EXPECT_EQ(report.misoriented_edges, expected.misoriented_edges);
    EXPECT_EQ(report.first_misoriented_edge, expected.first_misoriented_edge);
    EXPECT_EQ(report.non_manifold_vertices, expected.non_manifold_vertices);
    EXPECT_EQ(report.first_non_manifold_vertex, expected.first_non_manifold_vertex);
    EXPECT_EQ(report.unused_vertices, expected.unused_vertices);
  }
}

}  // namespace
}  // namespace orchard
