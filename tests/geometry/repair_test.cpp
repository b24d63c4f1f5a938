#include "orchard/geometry/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "broken_meshes.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Triangle = std::array<Index, 3>;
using test::joined;
using test::soup;
using test::turned;
using test::unit_box;
using test::welded;
using test::with;

// The four corners of a chessboard of boxes: every inner edge is shared by boxes that touch along it only.
TriangleMesh chessboard() {
  TriangleMesh mesh;
  for (int i = 0; i < 27; ++i) {
    const int column = i % 3, row = i / 3 % 3, layer = i / 9;
    const Point corner(column, row, layer);
    if (i % 2 == 0) mesh = joined({mesh, test::box(corner, corner + Vector::Ones())});
  }
  return welded(mesh);
}

TEST(RepairMesh, MakesASolidOfWhatHasOneMeaning) {
  for (const test::BrokenMesh& broken : test::repairable()) {
    TriangleMesh mesh = broken.mesh;
    const MeshRepairReport report = repair_mesh(mesh);
    const MeshReport check = check_mesh(mesh);
    EXPECT_TRUE(report.solid && check.solid()) << broken.name << ": " << check.faults();
    EXPECT_EQ(check.unused_vertices, 0u) << broken.name;
    EXPECT_NEAR(check.volume, broken.volume, 1e-12) << broken.name;
    EXPECT_TRUE(report.changed()) << broken.name;
    EXPECT_FALSE(repair_mesh(mesh).changed()) << broken.name << " was not repaired at one go";
  }
}

constexpr std::pair<const char*, Index MeshRepairReport::*> kCounts[] = {
    {"vertices welded", &MeshRepairReport::vertices_welded},
    {"vertices joined", &MeshRepairReport::vertices_joined},
    {"cracks closed", &MeshRepairReport::cracks_closed},
    {"unused vertices dropped", &MeshRepairReport::unused_vertices_dropped},
    {"degenerate dropped", &MeshRepairReport::degenerate_dropped},
    {"neighbors split", &MeshRepairReport::neighbors_split},
    {"duplicates dropped", &MeshRepairReport::duplicates_dropped},
    {"flipped", &MeshRepairReport::flipped},
    {"edges cut", &MeshRepairReport::edges_cut},
    {"vertices split", &MeshRepairReport::vertices_split},
    {"holes filled", &MeshRepairReport::holes_filled},
    {"triangles added", &MeshRepairReport::triangles_added},
    {"parts turned outward", &MeshRepairReport::parts_turned_outward},
    {"cavities turned inward", &MeshRepairReport::cavities_turned_inward},
};

TEST(RepairMesh, CountsWhatItDid) {
  for (const test::BrokenMesh& broken : test::repairable()) {
    if (MeshRepairReport{broken.expected}.lines().empty()) continue;
    TriangleMesh mesh = broken.mesh;
    const MeshRepairReport report = repair_mesh(mesh), &expected = broken.expected;
    for (const auto& [name, count] : kCounts) EXPECT_EQ(report.*count, expected.*count) << broken.name << ": " << name;
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
  for (const test::BrokenMesh& broken : test::repairable()) {
    TriangleMesh mesh = broken.mesh;
    const MeshRepairReport report = repair_mesh(mesh);
    for (const int exponent : {-200, -20, 1, 30, 200}) {
      const double scale = std::ldexp(1.0, exponent);
      TriangleMesh scaled = test::transformed(broken.mesh, scale, Vector::Zero());
      const MeshRepairReport scaled_report = repair_mesh(scaled);
      EXPECT_EQ(scaled.triangles, mesh.triangles) << broken.name << " " << exponent;
      EXPECT_EQ(scaled.vertices, test::transformed(mesh, scale, Vector::Zero()).vertices) << broken.name;
      EXPECT_EQ(scaled_report.lines().size(), report.lines().size()) << broken.name;
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
