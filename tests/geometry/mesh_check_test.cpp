#include "orchard/geometry/mesh_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "broken_meshes.h"
#include "half_edge_mesh.h"
#include "half_edges.h"
#include "orchard/geometry/error.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Edge = std::array<Index, 2>;
using Triangle = std::array<Index, 3>;

struct Solid {
  const char* name;
  TriangleMesh mesh;
  Index components;
  std::int64_t euler;
  double area, volume;
};

std::vector<Solid> checked_solids() {
  constexpr double pi = std::numbers::pi;
  return {{"box", test::box(Point(0, 0, 0), Point(1, 2, 3)), 1, 2, 22, 6},
          {"icosphere", test::icosphere(5, 2), 1, 2, 16 * pi, 32 * pi / 3},
          {"torus", test::torus(200, 100, 1, 0.25), 1, 0, pi * pi, pi * pi / 8},
          {"l", test::l_shape(), 1, 2, 14, 3},
          {"u", test::u_shape(0.5), 1, 2, 23, 5.5},
          {"two boxes", test::two_boxes(0.5), 2, 4, 12, 2},
          {"touching boxes with vertices of their own", test::two_boxes(0), 2, 4, 12, 2}};
}

using test::unit_box;

// Two boxes that share the vertices that coincide.
TriangleMesh joined_boxes(const Vector& offset) {
  TriangleMesh mesh = test::joined({unit_box(), test::transformed(unit_box(), 1, offset)});
  for (Triangle& triangle : mesh.triangles) {
    for (Index& corner : triangle) {
      for (Index other = 0; other < 8; ++other) {
        if (mesh.vertices[other] == mesh.vertices[corner]) corner = std::min(corner, other);
      }
    }
  }
  return mesh;
}

TriangleMesh tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d) {
  return {{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

TEST(MeshCheck, MeasuresSolids) {
  for (const Solid& solid : checked_solids()) {
    SCOPED_TRACE(solid.name);
    const MeshReport report = check_mesh(solid.mesh);
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.faults(), "");
    EXPECT_EQ(report.components, solid.components);
    EXPECT_EQ(report.euler_characteristic, solid.euler);
    EXPECT_NEAR(report.area, solid.area, 0.01 * solid.area);
    EXPECT_NEAR(report.volume, solid.volume, 0.01 * solid.volume);
  }
}

TEST(MeshCheck, AgreesWithTheHalfEdgesOfOpenMesh) {
  for (const Solid& solid : checked_solids()) {
    EXPECT_TRUE(agrees(half_edge_mesh(solid.mesh), check_mesh(solid.mesh))) << solid.name;
  }
  EXPECT_TRUE(agrees(half_edge_mesh(test::open_box()), check_mesh(test::open_box())));
}

TEST(MeshCheck, NamesTheFirstBoundaryEdge) {
  const MeshReport report = check_mesh(test::open_box());
  EXPECT_FALSE(report.closed());
  EXPECT_TRUE(report.manifold());
  EXPECT_EQ(report.boundary_edges, 4u);
  EXPECT_EQ(report.first_boundary_edge, (Edge{5, 4}));
  EXPECT_EQ(report.faults(), "4 boundary edges (the first joins vertices 5 and 4)");
}

TEST(MeshCheck, TellsBoxesThatShareAnEdgeFromBoxesThatShareAVertex) {
  const MeshReport edge = check_mesh(joined_boxes(Vector(1, 1, 0)));
  EXPECT_EQ(edge.non_manifold_edges, 1u);
  EXPECT_EQ(edge.non_manifold_vertices, 0u);
  EXPECT_EQ(edge.components, 1u);
  EXPECT_EQ(std::set<Index>(edge.first_non_manifold_edge.begin(), edge.first_non_manifold_edge.end()),
            (std::set<Index>{3, 7}));

  const MeshReport vertex = check_mesh(joined_boxes(Vector(1, 1, 1)));
  EXPECT_EQ(vertex.non_manifold_edges, 0u);
  EXPECT_EQ(vertex.non_manifold_vertices, 1u);
  EXPECT_EQ(vertex.first_non_manifold_vertex, 7u);
  EXPECT_EQ(vertex.components, 2u);
  EXPECT_EQ(vertex.faults(), "1 vertex where parts of the surface touch at a point (vertex 7)");
}

TEST(MeshCheck, CountsDegenerateTrianglesButNoEdgesOfRepeatedCorners) {
  TriangleMesh mesh = unit_box();
  mesh.triangles.push_back({4, 4, 5});
  const MeshReport report = check_mesh(mesh);
  EXPECT_TRUE(report.closed() && report.manifold());
  EXPECT_EQ(report.degenerate_triangles, 1u);
  EXPECT_EQ(report.first_degenerate_triangle, 12u);
  EXPECT_EQ(report.euler_characteristic, 2);
}

TEST(MeshCheck, CallsATriangleDegenerateOnlyIfItsAreaIsNothingButRounding) {
  const struct {
    const char* name;
    Point a, b, c;
    bool degenerate;
  } cases[] = {
      {"collinear", {0, 0, 0}, {1, 1, 1}, {2, 2, 2}, true},
      {"collinear up to rounding", {0.1, 0.1, 0.3}, {0.2, 0.2, 0.6}, {0.3, 0.3, 0.9}, true},
      {"coincident corners", {1, 2, 3}, {1, 2, 3}, {4, 5, 7}, true},
      {"all at one point", {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, true},
      {"needle", {0, 0, 0}, {1e-12, 0, 0}, {0, 1, 0}, false},
      {"needle, listed from its tip", {0, 1, 0}, {0, 0, 0}, {1e-12, 0, 0}, false},
      {"cap", {0, 0, 0}, {1, 0, 0}, {0.5, 1e-12, 0}, false},
      {"tiny", {0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, false},
      {"huge", {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}, false},
      {"huge, about the origin", {-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1.7e308, 0}, false},
      {"far away", {1e6, 1e6, 1e6}, {1e6 + 1e-6, 1e6, 1e6}, {1e6, 1e6 + 1e-6, 1e6}, false},
  };
  for (const auto& [name, a, b, c, degenerate] : cases) {
    const MeshReport report = check_mesh({{a, b, c}, {{0, 1, 2}}});
    EXPECT_EQ(report.degenerate_triangles, degenerate ? 1u : 0u) << name;
  }
}

TEST(MeshCheck, FindsNoVolumeInAFlatBag) {
  TriangleMesh bag = test::transformed(test::icosphere(3), 1, Vector(10, 20, 30));
  const Vector direction = Vector(1, 2, 3).normalized();
  for (Point& vertex : bag.vertices) vertex -= direction * direction.dot(vertex);
  const MeshReport report = check_mesh(bag);
  EXPECT_TRUE(report.closed() && report.manifold());
  EXPECT_EQ(report.volume, 0);
  EXPECT_FALSE(report.solid());
  EXPECT_EQ(report.faults(), "it encloses no volume");
}

TEST(MeshCheck, CountsUnusedVerticesWithoutBlame) {
  TriangleMesh mesh = unit_box();
  mesh.vertices.insert(mesh.vertices.begin(), Point(1e30, 0, 0));
  for (Triangle& triangle : mesh.triangles) {
    for (Index& corner : triangle) ++corner;
  }
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.unused_vertices, 1u);
  EXPECT_TRUE(report.solid());
  EXPECT_EQ(report.volume, 1);
}

TEST(MeshCheck, AcceptsACavity) {
  TriangleMesh mesh = unit_box();
  mesh = test::joined({mesh, test::mirrored(test::box(Point(-0.75, 0.25, 0.25), Point(-0.25, 0.75, 0.75)))});
  const MeshReport report = check_mesh(mesh);
  EXPECT_TRUE(report.solid());
  EXPECT_DOUBLE_EQ(report.volume, 1 - 0.125);
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(check_mesh(mesh).faults(), "it is inside out");
  EXPECT_TRUE(require_solid(mesh));
}

TEST(MeshCheck, TellsAPartTurnedInsideOutFromACavity) {
  TriangleMesh mesh = test::box(Point(0, 0, 0), Point(2, 1, 1));
  mesh = test::joined({mesh, test::mirrored(test::box(Point(-4, 0, 0), Point(-3, 1, 1)))});
  for (const bool turned : {false, true}) {
    const MeshReport report = check_mesh(mesh);
    EXPECT_EQ(report.inside_out_components, 1u);
    EXPECT_EQ(report.first_inside_out_triangle, 12u);
    EXPECT_FALSE(report.solid());
    EXPECT_EQ(report.faults(), "1 part of the mesh turned inside out against the rest (at triangle 12)") << turned;
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  }
}

TEST(MeshCheck, ScalesExactlyByPowersOfTwo) {
  TriangleMesh mesh = test::torus(17, 9);
  mesh.triangles.pop_back();
  const MeshReport report = check_mesh(mesh);
  for (const int exponent : {-300, -20, 1, 30, 300}) {
    const MeshReport scaled = check_mesh(test::transformed(mesh, std::ldexp(1.0, exponent), Vector::Zero()));
    EXPECT_EQ(scaled.area, std::ldexp(report.area, 2 * exponent)) << exponent;
    EXPECT_EQ(scaled.volume, std::ldexp(report.volume, 3 * exponent)) << exponent;
    EXPECT_EQ(scaled.faults(), report.faults()) << exponent;
  }
}

TEST(MeshCheck, KeepsTheSignOfAVolumeThatIsTooSmallForADouble) {
  EXPECT_TRUE(check_mesh(test::transformed(test::l_shape(), 1e-150, Vector::Zero())).solid());
  EXPECT_LT(check_mesh(test::transformed(test::mirrored(test::l_shape()), 1e-150, Vector::Zero())).volume, 0);
}

TEST(MeshCheck, MeasuresFarFromTheOrigin) {
  const MeshReport report = check_mesh(test::transformed(test::l_shape(), 1, Vector(1e6, -1e6, 1e6)));
  EXPECT_TRUE(report.solid());
  EXPECT_DOUBLE_EQ(report.volume, 3);
}

TEST(MeshCheck, FindsNeighboursWhereExactlyTwoTrianglesMeet) {
  const TriangleMesh mesh = joined_boxes(Vector(1, 1, 0));
  const auto neighbors = triangle_neighbors(mesh);
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge{mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]};
      const Index other = neighbors[t][i];
      if (other == kNone) {
        EXPECT_EQ((std::set<Index>{edge[0], edge[1]}), (std::set<Index>{3, 7}));
        continue;
      }
      EXPECT_EQ(std::ranges::count(mesh.triangles[other], edge[0]), 1);
      EXPECT_EQ(std::ranges::count(mesh.triangles[other], edge[1]), 1);
      EXPECT_EQ(std::ranges::count(neighbors[other], t), 1);
    }
  }
}

TEST(RequireSolid, LeavesASolidAlone) {
  for (const Solid& solid : checked_solids()) {
    TriangleMesh mesh = solid.mesh;
    EXPECT_FALSE(require_solid(mesh)) << solid.name;
    EXPECT_EQ(mesh.triangles, solid.mesh.triangles) << solid.name;
  }
}

TEST(RequireSolid, TurnsAMeshThatIsInsideOut) {
  for (const Solid& solid : checked_solids()) {
    TriangleMesh mesh = test::mirrored(solid.mesh);
    EXPECT_EQ(check_mesh(mesh).faults(), "it is inside out") << solid.name;
    EXPECT_TRUE(require_solid(mesh)) << solid.name;
    EXPECT_TRUE(check_mesh(mesh).solid()) << solid.name;
  }
}

TEST(RequireSolid, SaysInOneSentenceWhatIsWrong) {
  TriangleMesh turned = unit_box(), doubled = unit_box(), collapsed = unit_box(), mixed = test::open_box();
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  doubled.triangles.push_back(doubled.triangles[2]);
  collapsed.triangles.push_back({0, 1, 1});
  mixed.triangles.push_back({0, 2, 3});
  TriangleMesh half_turned = unit_box();
  half_turned = test::joined({half_turned, test::mirrored(test::box(Point(-9, 0, 0), Point(-8, 2, 2)))});
  const struct {
    const char* name;
    TriangleMesh mesh;
    const char* message;
  } cases[] = {
      {"one part turned", half_turned, "1 part of the mesh turned inside out against the rest (at triangle 0)"},
      {"open", test::open_box(), "4 boundary edges (the first joins vertices 5 and 4)"},
      {"one triangle turned", turned, "3 edges between triangles of opposite orientation (the first joins vertices"},
      {"one triangle twice", doubled, "3 non-manifold edges (the first joins vertices"},
      {"repeated corner", collapsed, "1 degenerate triangle (triangle 12)"},
      {"shared vertex", joined_boxes(Vector(1, 1, 1)), "1 vertex where parts of the surface touch"},
      {"open, inside out", test::mirrored(test::open_box()), "4 boundary edges (the first joins vertices 5 and 4)"},
      {"several faults", mixed, "4 boundary edges (the first joins vertices 5 and 4), 3 non-manifold edges"},
      {"flat", tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), "encloses no volume"},
      {"no triangles", {{Point(0, 0, 0)}, {}}, "no triangles"},
      {"empty", {}, "no triangles"},
  };
  for (const auto& [name, mesh, message] : cases) {
    TriangleMesh copy = mesh;
    try {
      require_solid(copy);
      ADD_FAILURE() << name << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << name << ": " << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
    EXPECT_EQ(copy.triangles, mesh.triangles) << name;
  }
}

}  // namespace
}  // namespace orchard
