#include "orchard/geometry/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Triangle = std::array<Index, 3>;

TriangleMesh unit_box() { return test::box(Point(0, 0, 0), Point(1, 1, 1)); }

TriangleMesh joined(std::initializer_list<TriangleMesh> parts) {
  TriangleMesh mesh;
  for (const TriangleMesh& part : parts) {
    const Index first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  }
  return mesh;
}

// Vertices at the same place become one, as in a file without connectivity that a reader welds.
TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (Triangle t : mesh.triangles) {
    for (Index& vertex : t) {
      const auto at = std::ranges::find(result.vertices, mesh.vertices[vertex]);
      const Index number = static_cast<Index>(at - result.vertices.begin());
      if (at == result.vertices.end()) result.vertices.push_back(mesh.vertices[vertex]);
      vertex = number;
    }
    result.triangles.push_back(t);
  }
  return result;
}

// Three vertices of its own for each triangle.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh bag;
  for (const Triangle& t : mesh.triangles) {
    const Index first = static_cast<Index>(bag.vertices.size());
    for (const Index vertex : t) bag.vertices.push_back(mesh.vertices[vertex]);
    bag.triangles.push_back({first, first + 1, first + 2});
  }
  return bag;
}

TriangleMesh turned(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh without(TriangleMesh mesh, std::size_t triangle) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
  return mesh;
}

TriangleMesh turned_triangles(TriangleMesh mesh, std::uint64_t seed) {
  Random random(seed, 0);
  for (Triangle& t : mesh.triangles)
    if (random.uniform() < 0.3) std::swap(t[0], t[1]);
  return mesh;
}

TriangleMesh with(TriangleMesh mesh, std::initializer_list<Triangle> triangles) {
  mesh.triangles.insert(mesh.triangles.end(), triangles);
  return mesh;
}

// A box with a vertex in the middle of the edge between vertices 0 and 1, on one side of it only.
TriangleMesh box_with_t_junction(double depth = 0) {
  TriangleMesh mesh = unit_box();
  mesh.vertices.emplace_back(0.5, 0, depth);
  const auto at = std::ranges::find(mesh.triangles, Triangle{0, 1, 5});
  *at = {0, 8, 5};
  mesh.triangles.push_back({8, 1, 5});
  return mesh;
}

// The same, closed by a triangle without area.
TriangleMesh box_with_flat_triangle() { return with(box_with_t_junction(), {{0, 1, 8}}); }

// A ball without two triangles that share a vertex but no edge.
TriangleMesh without_opposite_triangles() {
  TriangleMesh ball = test::icosphere(2);
  const Index vertex = 20;
  std::vector<std::size_t> fan;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    if (std::ranges::count(ball.triangles[t], vertex) > 0) fan.push_back(t);
  const auto shared = [&](std::size_t a, std::size_t b) {
    return std::ranges::count_if(ball.triangles[a],
                                 [&](Index v) { return std::ranges::count(ball.triangles[b], v) > 0; });
  };
  const auto other = std::ranges::find_if(fan, [&](std::size_t t) { return shared(fan[0], t) == 1; });
  return without(without(ball, *other), fan[0]);
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  double volume;  // of the solid that it stands for
  MeshRepairReport expected;
};

std::vector<Case> repairable() {
  const TriangleMesh ball = test::icosphere(2), inner = test::box(Point(0.2, 0.2, 0.2), Point(0.7, 0.7, 0.7));
  const TriangleMesh innermost = test::box(Point(0.3, 0.3, 0.3), Point(0.5, 0.5, 0.5));
  const double ball_volume = check_mesh(ball).volume;
  std::vector<Case> cases{
      {"a bag of triangles", soup(unit_box()), 1, {.vertices_welded = 28}},
      {"inside out", turned(unit_box()), 1, {.parts_turned_outward = 1}},
      {"a triangle turned round", turned_triangles(ball, 1), ball_volume, {}},
      {"a triangle twice", with(unit_box(), {{2, 3, 0}}), 1, {.duplicates_dropped = 1}},
      {"all triangles in both orientations",
       joined({unit_box(), turned(unit_box())}),
       1,
       {.vertices_welded = 8, .duplicates_dropped = 12}},
      {"all triangles twice",
       joined({unit_box(), unit_box()}),
       1,
       {.unused_vertices_dropped = 8, .duplicates_dropped = 12}},
      {"a vertex near an edge", box_with_t_junction(1e-5), 1, {.holes_filled = 1, .triangles_added = 1}},
      {"a triangle off a bag",
       without(soup(ball), 3),
       ball_volume,
       {.vertices_welded = 3 * 319 - 162, .unused_vertices_dropped = 3, .holes_filled = 1, .triangles_added = 1}},
      {"holes that touch at a vertex",
       without_opposite_triangles(),
       ball_volume,
       {.holes_filled = 2, .triangles_added = 2}},

      {"a repeated corner", with(unit_box(), {{3, 3, 5}}), 1, {.degenerate_dropped = 1}},
      {"a triangle without area", box_with_flat_triangle(), 1, {.degenerate_dropped = 1, .neighbors_split = 1}},
      {"a vertex on an edge",
       box_with_t_junction(),
       1,
       {.degenerate_dropped = 1, .neighbors_split = 1, .holes_filled = 1, .triangles_added = 1}},
      {"a hole", without(ball, 17), ball_volume, {.holes_filled = 1, .triangles_added = 1}},
      {"unused vertices", {{Point(9, 9, 9)}, {}}, 1, {.unused_vertices_dropped = 1}},
      {"boxes that touch at a vertex",
       welded(joined({unit_box(), test::box(Point(1, 1, 1), Point(2, 2, 2))})),
       2,
       {.vertices_split = 1}},
      {"boxes that touch along an edge",
       welded(joined({unit_box(), test::box(Point(1, 1, 0), Point(2, 2, 1))})),
       2,
       {.edges_cut = 1, .vertices_split = 2}},
      {"boxes that share a side",
       welded(joined({unit_box(), test::box(Point(1, 0, 0), Point(2, 1, 1))})),
       2,
       {.edges_cut = 5, .vertices_split = 4}},
      {"a part inside out beside another",
       joined({unit_box(), turned(test::box(Point(3, 0, 0), Point(4, 1, 1)))}),
       2,
       {.parts_turned_outward = 1}},
      {"a part inside another one", joined({inner, unit_box()}), 1 - 0.125, {.cavities_turned_inward = 1}},
      {"a hollow box inside out",
       joined({inner, turned(unit_box())}),
       1 - 0.125,
       {.parts_turned_outward = 1, .cavities_turned_inward = 1}},
      {"a box in the cavity of a box, all inside out",
       joined({turned(innermost), inner, turned(unit_box())}),
       1 - 0.125 + 0.008,
       {.parts_turned_outward = 2, .cavities_turned_inward = 1}},
      {"parts that poke out of each other",
       joined({unit_box(), turned(test::box(Point(0.5, 0.5, 0.5), Point(1.5, 1.5, 1.5)))}),
       2,
       {.parts_turned_outward = 1}},
  };
  TriangleMesh& unused = std::ranges::find(cases, std::string("unused vertices"), &Case::name)->mesh;
  unused = unit_box();
  unused.vertices.emplace_back(9, 9, 9);
  return cases;
}

// The four corners of a chessboard of boxes: every inner edge is shared by boxes that touch along it only.
TriangleMesh chessboard() {
  TriangleMesh mesh;
  for (int i = 0; i < 27; ++i) {
    const Point corner(i % 3, i / 3 % 3, i / 9);
    if (i % 2 == 0) mesh = joined({mesh, test::box(corner, corner + Vector::Ones())});
  }
  return welded(mesh);
}

TEST(RepairMesh, MakesASolidOfWhatHasOneMeaning) {
  for (const Case& test : repairable()) {
    TriangleMesh mesh = test.mesh;
    const MeshRepairReport report = repair_mesh(mesh);
    const MeshReport check = check_mesh(mesh);
    EXPECT_TRUE(report.solid && check.solid()) << test.name << ": " << check.faults();
    EXPECT_EQ(check.unused_vertices, 0u) << test.name;
    EXPECT_NEAR(check.volume, test.volume, 1e-12) << test.name;
    EXPECT_TRUE(report.changed()) << test.name;
    EXPECT_FALSE(repair_mesh(mesh).changed()) << test.name << " was not repaired at one go";
  }
}

TEST(RepairMesh, CountsWhatItDid) {
  for (const Case& test : repairable()) {
    if (MeshRepairReport{test.expected}.lines().empty()) continue;
    TriangleMesh mesh = test.mesh;
    const MeshRepairReport report = repair_mesh(mesh), &expected = test.expected;
    EXPECT_EQ(report.vertices_welded, expected.vertices_welded) << test.name;
    EXPECT_EQ(report.unused_vertices_dropped, expected.unused_vertices_dropped) << test.name;
    EXPECT_EQ(report.degenerate_dropped, expected.degenerate_dropped) << test.name;
    EXPECT_EQ(report.neighbors_split, expected.neighbors_split) << test.name;
    EXPECT_EQ(report.duplicates_dropped, expected.duplicates_dropped) << test.name;
    EXPECT_EQ(report.flipped, expected.flipped) << test.name;
    EXPECT_EQ(report.edges_cut, expected.edges_cut) << test.name;
    EXPECT_EQ(report.vertices_split, expected.vertices_split) << test.name;
    EXPECT_EQ(report.holes_filled, expected.holes_filled) << test.name;
    EXPECT_EQ(report.triangles_added, expected.triangles_added) << test.name;
    EXPECT_EQ(report.parts_turned_outward, expected.parts_turned_outward) << test.name;
    EXPECT_EQ(report.cavities_turned_inward, expected.cavities_turned_inward) << test.name;
  }
}

TEST(RepairMesh, KeepsEveryByteOfASolid) {
  for (const TriangleMesh& solid :
       {unit_box(), test::torus(9, 7), test::l_shape(), test::two_boxes(0), test::two_boxes(0.5),
        joined({unit_box(), turned(test::box(Point(.2, .2, .2), Point(.7, .7, .7)))})}) {
    TriangleMesh mesh = solid;
    const MeshRepairReport report = repair_mesh(mesh);
    EXPECT_TRUE(report.lines().empty()) << report.lines().front();
    EXPECT_TRUE(report.solid);
    EXPECT_EQ(mesh.vertices, solid.vertices);
    EXPECT_EQ(mesh.triangles, solid.triangles);
  }
}

TEST(RepairMesh, LeavesAloneWhatIsNotSafe) {
  const struct {
    const char* name;
    TriangleMesh mesh;
    const char* fault;
  } cases[] = {
      {"a large hole", test::open_box(), "4 boundary edges"},
      {"a lone triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "3 boundary edges"},
      {"a wall inside", with(unit_box(), {{0, 4, 7}, {0, 7, 3}}), "4 boundary edges"},
      {"nothing but a triangle without area", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, "no triangles"},
  };
  for (const auto& [name, mesh, fault] : cases) {
    TriangleMesh copy = mesh;
    const MeshRepairReport report = repair_mesh(copy);
    EXPECT_FALSE(report.solid) << name;
    EXPECT_NE(report.faults.find(fault), std::string::npos) << name << ": " << report.faults;
  }
}

TEST(RepairMesh, FillsHolesUpToTheLimitsOnly) {
  // The hole is the fan around a vertex.
  TriangleMesh holed = test::icosphere(3);
  std::erase_if(holed.triangles, [](const Triangle& t) { return std::ranges::count(t, 0u) > 0; });
  const double size = 2 * (holed.vertices[holed.triangles[0][0]] - holed.vertices[0]).norm();
  TriangleMesh mesh = holed;
  const MeshRepairReport report = repair_mesh(mesh);
  EXPECT_TRUE(report.solid);
  EXPECT_EQ(report.holes_filled, 1u);
  EXPECT_EQ(report.triangles_added, 3u);
  EXPECT_LT(report.max_hole, size);
  EXPECT_GT(report.max_hole, 0);
  for (const RepairMeshOptions& options :
       {RepairMeshOptions{.max_hole_edges = 4}, RepairMeshOptions{.max_hole_diameter = 0.9 * report.max_hole}}) {
    mesh = holed;
    EXPECT_FALSE(repair_mesh(mesh, options).solid);
    EXPECT_EQ(mesh.triangles, holed.triangles);
  }
}

TEST(RepairMesh, ClosesABallWhateverTrianglesAreMissing) {
  const TriangleMesh ball = test::icosphere(3);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 1);
    TriangleMesh mesh = ball;
    for (int i = 0; i < 20; ++i)
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(random.below(mesh.triangles.size())));
    mesh = random.uniform() < 0.5 ? mesh : soup(mesh);
    const MeshRepairReport report = repair_mesh(mesh);
    EXPECT_TRUE(report.solid) << "seed " << seed << ": " << report.faults;
    EXPECT_NEAR(check_mesh(mesh).volume, check_mesh(ball).volume, 0.03) << "seed " << seed;
  }
}

TEST(RepairMesh, CutsAChessboardOfBoxesIntoSolids) {
  TriangleMesh mesh = chessboard();
  ASSERT_GT(check_mesh(mesh).non_manifold_edges, 0u);
  const MeshRepairReport report = repair_mesh(mesh);
  EXPECT_TRUE(report.solid) << report.faults;
  EXPECT_NEAR(check_mesh(mesh).volume, 14, 1e-9);
  EXPECT_EQ(check_mesh(mesh).components, 14u);
}

// A ring of boxes that closes on itself along one edge: both ends of that edge belong to one fan, so the edge needs
// vertices of its own.
TEST(RepairMesh, CutsAnEdgeThatASolidTouchesItselfAlong) {
  TriangleMesh mesh;
  const Point cells[] = {{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, -1}, {1, 0, -1}, {1, 1, -1}};
  for (const Point& corner : cells) mesh = joined({mesh, test::box(corner, corner + Vector::Ones())});
  mesh = welded(mesh);
  // Walls between neighbouring boxes go: they come in pairs.
  std::vector<bool> wall(mesh.triangles.size(), false);
  const auto middle_of_side = [&](const Triangle& t) {
    std::array<Point, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices[t[i]];
    Point middle = p[0];
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if ((p[i] - p[(i + 1) % 3]).norm() > longest) {
        longest = (p[i] - p[(i + 1) % 3]).norm();
        middle = (p[i] + p[(i + 1) % 3]) / 2;
      }
    return middle;
  };
  for (std::size_t i = 0; i < wall.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (middle_of_side(mesh.triangles[i]) == middle_of_side(mesh.triangles[j]) && (i / 12 != j / 12))
        wall[i] = wall[j] = true;
  TriangleMesh ring{mesh.vertices, {}};
  for (std::size_t i = 0; i < wall.size(); ++i)
    if (!wall[i]) ring.triangles.push_back(mesh.triangles[i]);
  ASSERT_EQ(check_mesh(ring).non_manifold_edges, 1u);
  ASSERT_EQ(check_mesh(ring).boundary_edges, 0u);
  const MeshRepairReport report = repair_mesh(ring);
  EXPECT_TRUE(report.solid) << report.faults;
  EXPECT_EQ(report.edges_cut, 1u);
  EXPECT_NEAR(check_mesh(ring).volume, 8, 1e-9);
}

TEST(RepairMesh, SurvivesAnyTriangles) {
  int solids = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed, 2);
    TriangleMesh mesh;
    const std::uint64_t vertices = 3 + random.below(6), triangles = 1 + random.below(14);
    // On a grid of 27 places, so that vertices coincide and triangles overlap.
    const auto coordinate = [&] { return static_cast<double>(random.below(3)); };
    for (std::uint64_t i = 0; i < vertices; ++i) mesh.vertices.emplace_back(coordinate(), coordinate(), coordinate());
    const auto vertex = [&] { return static_cast<Index>(random.below(vertices)); };
    for (std::uint64_t i = 0; i < triangles; ++i) mesh.triangles.push_back({vertex(), vertex(), vertex()});
    const MeshRepairReport report = repair_mesh(mesh, {.max_hole_diameter = 4});
    if (!mesh.triangles.empty()) validate(mesh);
    EXPECT_EQ(report.solid, check_mesh(mesh).solid()) << "seed " << seed;
    EXPECT_EQ(report.solid, report.faults.empty()) << "seed " << seed;
    if (!report.solid) continue;
    ++solids;
    const MeshRepairReport again = repair_mesh(mesh);
    EXPECT_TRUE(again.lines().empty()) << "seed " << seed << ": " << again.lines().front();
  }
  EXPECT_GT(solids, 100);
}

TEST(RepairMesh, ScalesExactlyByPowersOfTwo) {
  for (const Case& test : repairable()) {
    TriangleMesh mesh = test.mesh;
    const MeshRepairReport report = repair_mesh(mesh);
    for (const int exponent : {-200, -20, 1, 30, 200}) {
      const double scale = std::ldexp(1.0, exponent);
      TriangleMesh scaled = test::transformed(test.mesh, scale, Vector::Zero());
      const MeshRepairReport scaled_report = repair_mesh(scaled);
      EXPECT_EQ(scaled.triangles, mesh.triangles) << test.name << " " << exponent;
      EXPECT_EQ(scaled.vertices, test::transformed(mesh, scale, Vector::Zero()).vertices) << test.name;
      EXPECT_EQ(scaled_report.lines().size(), report.lines().size()) << test.name;
    }
  }
}

TEST(RepairMesh, MendsTheSharedModels) {
  const std::filesystem::path folder = std::filesystem::path(ORCHARD_SHARED_MODELS) / "dirty";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared models";
  TriangleMesh cow = read_mesh(folder / "cow.obj");
  EXPECT_EQ(repair_mesh(cow).vertices_split, 1u);
  EXPECT_TRUE(check_mesh(cow).solid());
  TriangleMesh bunny = read_mesh(folder / "stanford-bunny.obj");
  EXPECT_EQ(repair_mesh(bunny).holes_filled, 5u);
  EXPECT_TRUE(check_mesh(bunny).solid());
}

TEST(MeshRepairReport, SaysEachThingInALine) {
  const MeshRepairReport report{
      .vertices_welded = 1, .degenerate_dropped = 2, .holes_filled = 3, .triangles_added = 10, .max_hole = 0.0123456};
  EXPECT_EQ(report.lines(), (std::vector<std::string>{"welded 1 vertex to another in the same place",
                                                      "dropped 2 triangles without area",
                                                      "filled 3 holes with 10 triangles, the largest 0.0123 across"}));
}

}  // namespace
}  // namespace orchard
