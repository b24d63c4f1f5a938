// Contractions, which keep the topology of a medial mesh whatever their order, and the fewest vertices that it allows.
#include "simplify/contractible_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "known_axes.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "orchard/medial/topology.h"
#include "simplify/least_vertices.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using detail::Ball4;
using detail::ContractibleMesh;

// Not refined: fewer vertices, which are there sooner, with seams and borders as well.
MedialMesh raw_axis(const TriangleMesh& solid) {
  return medial_mesh(build_medial_axis(Surface(solid), {.sampling = {.face_points = 160, .edge_points = 40}}).axis);
}

// All of a mesh as a medial mesh: the surface of a solid, whose Betti numbers have loops and cavities.
MedialMesh shell_of(const TriangleMesh& mesh) {
  MedialMesh shell;
  shell.centers = mesh.vertices;
  shell.radii.assign(mesh.vertices.size(), 0.1);
  for (auto triangle : mesh.triangles) {
    std::sort(triangle.begin(), triangle.end());
    shell.triangles.push_back(triangle);
  }
  complete(shell);
  return shell;
}

std::vector<std::array<Index, 2>> contractible_edges(const ContractibleMesh& mesh) {
  std::vector<std::array<Index, 2>> edges;
  for (Index v = 0; v < mesh.size(); ++v) {
    for (const Index other : mesh.neighbors(v)) {
      if (v < other && mesh.may_contract(v, other)) edges.push_back({v, other});
    }
  }
  return edges;
}

// An edge that may be contracted, at random as long as that is quick; nothing if there is none.
std::optional<std::array<Index, 2>> some_edge(const ContractibleMesh& mesh, Random& random) {
  for (int i = 0; i < 200; ++i) {
    const auto v = static_cast<Index>(random.below(mesh.size()));
    if (!mesh.alive(v) || mesh.neighbors(v).empty()) continue;
    const Index other = mesh.neighbors(v)[random.below(mesh.neighbors(v).size())];
    if (mesh.may_contract(v, other)) return std::array{v, other};
  }
  const auto edges = contractible_edges(mesh);
  if (edges.empty()) return std::nullopt;
  return edges[random.below(edges.size())];
}

// Random contractions, and divisions and extensions between them, until no edge may be contracted.
int contract_at_random(const MedialMesh& start, std::uint64_t seed, const Topology& expected, Index& left) {
  ContractibleMesh mesh(start);
  Random random(seed, 1);
  int contractions = 0;
  for (int step = 0;; ++step) {
    const auto edge = some_edge(mesh, random);
    if (!edge) break;
    const auto [a, b] = *edge;
    const Ball4 middle = 0.5 * (mesh.ball(a) + mesh.ball(b));
    if (step % 16 == 7) {
      mesh.divide(a, b, middle);
    } else if (step % 16 == 11) {
      mesh.extend(a, b, middle + Ball4(0.1, 0, 0, 0));
    } else {
      mesh.contract(a, b, middle);
      ++contractions;
    }
    if (step % 64 == 0) {
      const MedialMesh now = mesh.mesh();
      EXPECT_NO_THROW(validate(now));
      EXPECT_EQ(topology(now), expected) << "seed " << seed << " step " << step;
    }
  }
  EXPECT_EQ(topology(mesh.mesh()), expected) << "seed " << seed;
  left = mesh.living();
  return contractions;
}

TEST(ContractibleMesh, KeepsTheBettiNumbersThroughAThousandRandomContractions) {
  struct NamedMesh {
    const char* name;
    MedialMesh mesh;
    Topology expected;
  };
  const std::vector<NamedMesh> cases{{"torus shell", shell_of(test::torus(14, 9)), {1, 2, 1}},
                                     {"two shells", shell_of(test::two_boxes(0.5)), {2, 0, 2}},
                                     {"axis of a torus", raw_axis(test::torus(24, 12)), {1, 1, 0}},
                                     {"axis of an L with seams", raw_axis(test::l_shape()), {1, 0, 0}}};
  int contractions = 0;
  for (const auto& [name, mesh, expected] : cases) {
    SCOPED_TRACE(name);
    ASSERT_EQ(topology(mesh), expected);
    for (std::uint64_t k = 0; k < 2 * test::more(); ++k) {
      const std::uint64_t seed = 1 + k + test::first_seed();
      Index left = 0;
      contractions += contract_at_random(mesh, seed, expected, left);
      EXPECT_LE(left, mesh.size() / 2);
    }
  }
  EXPECT_GE(contractions, 1000);
}

TEST(ContractibleMesh, RefusesContractionsThatCloseALoopOrACavity) {
  MedialMesh ring;
  ring.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  ring.radii = {1, 1, 1};
  ring.edges = {{0, 1}, {0, 2}, {1, 2}};
  complete(ring);
  EXPECT_TRUE(contractible_edges(ContractibleMesh(ring)).empty());
  MedialMesh hollow;
  hollow.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  hollow.radii = {1, 1, 1, 1};
  hollow.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  complete(hollow);
  EXPECT_TRUE(contractible_edges(ContractibleMesh(hollow)).empty());
}

// Random two-dimensional complexes on few vertices, and all that are small enough.
MedialMesh complex_of(Index vertices, std::uint64_t edges, std::uint64_t triangles) {
  MedialMesh mesh;
  for (Index a = 0; a < vertices; ++a) {
    mesh.centers.emplace_back(a, a * a, a * a * a);
    mesh.radii.push_back(1);
    for (Index b = a + 1; b < vertices; ++b, edges >>= 1) {
      if (edges & 1) mesh.edges.push_back({a, b});
      for (Index c = b + 1; c < vertices; ++c, triangles >>= 1) {
        if (triangles & 1) mesh.triangles.push_back({a, b, c});
      }
    }
  }
  complete(mesh);
  return mesh;
}

TEST(LeastVertices, AreNoMoreThanThoseOfAnyComplexAndThoseOfSome) {
  EXPECT_EQ(detail::least_vertices(0, 0), 1u);
  EXPECT_EQ(detail::least_vertices(1, 0), 3u);
  EXPECT_EQ(detail::least_vertices(0, 1), 4u);
  EXPECT_EQ(detail::least_vertices(2, 0), 4u);
  std::map<std::pair<std::int64_t, std::int64_t>, Index> fewest;  // of loops and cavities
  const auto look_at = [&](const MedialMesh& mesh) {
    const Topology found = topology(mesh);
    if (found.components == 1) {
      const auto at = fewest.try_emplace({found.loops, found.cavities}, mesh.size()).first;
      at->second = std::min(at->second, mesh.size());
    }
    EXPECT_LE(detail::least_vertices(mesh), mesh.size());
  };
  const std::array<std::uint64_t, 5> triangles_of{0, 0, 0, 1, 4};
  for (Index n = 1; n <= 4; ++n) {
    for (std::uint64_t e = 0; e < (std::uint64_t{1} << (n * (n - 1) / 2)); ++e) {
      for (std::uint64_t t = 0; t < (std::uint64_t{1} << triangles_of[n]); ++t) look_at(complex_of(n, e, t));
    }
  }
  for (const auto& [betti, vertices] : fewest)
    EXPECT_EQ(detail::least_vertices(betti.first, betti.second), vertices) << betti.first << ' ' << betti.second;
  // Some of those with more: bounds hold, and are met by full sets of edges, of triangles, and both.
  Random random(11 + test::first_seed(), 3);
  for (std::uint64_t k = 0; k < 1000 * test::more(); ++k) {
    const Index n = k % 2 == 0 ? 5 : 6;
    const std::uint64_t edges = random.below(1 << 15), triangles = random.below(1 << 20);
    look_at(complex_of(n, edges, triangles & random.below(1 << 20)));
  }
  EXPECT_EQ(detail::least_vertices(6, 0), 5u);  // all edges of five
  EXPECT_EQ(detail::least_vertices(0, 4), 5u);  // all triangles of five
  EXPECT_EQ(detail::least_vertices(1, 1), 5u);
  EXPECT_EQ(detail::least_vertices(0, 10), 6u);
}

TEST(ContractibleMesh, MergesEdgesOfRingsThatShareAVertexDownToTheLeastNumber) {
  for (const int rings : {1, 2, 3, 5, 8}) {
    MedialMesh rose;
    rose.centers.emplace_back(0, 0, 0);
    rose.radii.push_back(1);
    for (int k = 0; k < rings; ++k) {
      const Index a = rose.size();
      for (const double turn : {0.0, 0.4}) {
        const double angle = k + turn;
        rose.centers.emplace_back(std::cos(angle), std::sin(angle), 0.1 * k);
        rose.radii.push_back(0.5);
      }
      for (const auto& edge : {std::array<Index, 2>{0, a}, {0, a + 1}, {a, a + 1}}) rose.edges.push_back(edge);
    }
    complete(rose);
    ContractibleMesh mesh(rose);
    EXPECT_TRUE(contractible_edges(mesh).empty());
    while (mesh.merge_edges()) {
      EXPECT_EQ(topology(mesh.mesh()), (Topology{1, rings, 0}));
      EXPECT_NO_THROW(validate(mesh.mesh()));
    }
    EXPECT_GE(mesh.living(), detail::least_vertices(rose));
    if (rings <= 3) {
      EXPECT_EQ(mesh.living(), detail::least_vertices(rose)) << rings;
    }
  }
}

}  // namespace
}  // namespace orchard
