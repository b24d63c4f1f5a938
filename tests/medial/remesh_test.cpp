// What evening out makes of a medial axis: triangles of good shape that do not fold, exact balls, the solid's topology,
// and nothing uncovered. On sheets made by hand, and on axes of solids whose axes are known.
#include "remesh/remesh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "known_axes.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "outlines.h"
#include "quality/reconstruction.h"
#include "support.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Edge = std::array<Index, 2>;

using test::diagonal;

// 1 for a triangle with equal sides, 0 for one without area.
double quality_of(const Point& a, const Point& b, const Point& c) {
  const double x = (b - a).norm(), y = (c - b).norm(), z = (a - c).norm();
  const double area = (b - a).cross(c - a).norm() / 2, half = (x + y + z) / 2;
  return 6 / std::sqrt(3.0) * area / (half * std::max({x, y, z}));
}

// The corners opposite to each edge of a triangle.
std::map<Edge, std::vector<Index>> opposite_corners(const MedialMesh& mesh) {
  std::map<Edge, std::vector<Index>> opposite;
  for (const auto& [a, b, c] : mesh.triangles) {
    opposite[{a, b}].push_back(c);
    opposite[{b, c}].push_back(a);
    opposite[{a, c}].push_back(b);
  }
  return opposite;
}

std::vector<Edge> bare_edges(const MedialMesh& mesh) {
  const std::map<Edge, std::vector<Index>> opposite = opposite_corners(mesh);
  std::vector<Edge> bare = mesh.edges;
  std::erase_if(bare, [&](const Edge& edge) { return opposite.contains(edge); });
  return bare;
}

struct Shape {
  double mean_quality = 0;
  double slivers = 0;       // share of the triangles, of a quality below 0.1
  double longest_edge = 0;  // mesh units
  double folds = 0;         // share of the edges with two triangles, which turn by more than 100 degrees there
};

Shape shape_of(const MedialMesh& mesh) {
  constexpr double kFold = 100 * std::numbers::pi / 180;
  Shape shape;
  const auto triangles = static_cast<double>(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const double quality = quality_of(mesh.centers[a], mesh.centers[b], mesh.centers[c]);
    shape.mean_quality += quality / triangles;
    shape.slivers += quality < 0.1 ? 1 / triangles : 0;
  }
  for (const auto& [a, b] : mesh.edges)
    shape.longest_edge = std::max(shape.longest_edge, (mesh.centers[a] - mesh.centers[b]).norm());
  double pairs = 0;
  for (const auto& [edge, corners] : opposite_corners(mesh)) {
    if (corners.size() != 2) continue;
    const Point& start = mesh.centers[edge[0]];
    const Vector along = mesh.centers[edge[1]] - start;
    const Vector first = along.cross(mesh.centers[corners[0]] - start),
                 second = (mesh.centers[corners[1]] - start).cross(along);
    shape.folds += std::atan2(first.cross(second).norm(), first.dot(second)) > kFold ? 1 : 0;
    ++pairs;
  }
  if (pairs > 0) shape.folds /= pairs;
  return shape;
}

// ---- one sheet

// In the middle of a plate, a square of 20 x 20 vertices, shaken, with teeth along its border.
struct ShakenSheet {
  Surface plate{test::box(Point::Zero(), {4, 4, 0.4})};
  detail::FeatureEdges features{plate, {.min_loss = 0.02, .min_length = 0.3}};
  detail::BallComplex complex;
  std::vector<Point> places;
  detail::RemeshOptions options{
      .max_length = 0.3, .min_length = 0.04, .tolerance = 0.003, .limit = 0.05, .merging = 1e-4, .features = &features};

  ShakenSheet() {
    constexpr Index kSide = 20;
    Random random(3, 4);
    detail::BallSolver solver(plate, options.merging);
    // Of a row or column: the first and the last stick out, by as much as two steps.
    const auto along = [&](Index number) {
      const double tooth = random.uniform(0, 2), shake = random.uniform(-0.3, 0.3);
      return 0.5 + 0.15 * (number == 0 ? -tooth : number + 1 == kSide ? number + tooth : number + shake);
    };
    for (Index v = 0; v < kSide * kSide; ++v) {
      const double x = along(v % kSide), y = along(v / kSide);
      const Point place(x, y, 0.2);
      const std::array<ClosestPoint, 2> seeds{plate.closest(place + Vector(0, 0, 0.1)),
                                              plate.closest(place - Vector(0, 0, 0.1))};
      complex.balls.push_back(solver.solve(place, seeds));
      if (v % kSide + 1 == kSide || v / kSide + 1 == kSide) continue;
      complex.triangles.push_back({v, v + 1, v + kSide});
      complex.triangles.push_back({v + 1, v + kSide, v + kSide + 1});
    }
    complex.complete();
    // What the sheet covers, and little more.
    places = sample_surface(plate, {.face_points = 2000, .edge_points = 0, .iterations = 0, .seed = 5}).points;
    const detail::Reconstruction covered(complex.mesh());
    std::erase_if(places, [&](const Point& place) { return covered.distance(place) > 0.5 * options.limit; });
  }

  void even_out(std::uint8_t where = 1) {
    const std::vector<std::uint8_t> all(complex.size(), where);
    remesh(plate, places, complex, all, options, {});
  }
};

TEST(Remesh, EvensASheetOutAndUncoversNothing) {
  ShakenSheet sheet;
  const detail::Reconstruction before(sheet.complex.mesh());
  const Shape old = shape_of(sheet.complex.mesh());
  sheet.even_out();
  const MedialMesh mesh = sheet.complex.mesh();
  const detail::Reconstruction after(mesh);
  Index lost = 0;
  for (const Point& place : sheet.places) {
    const double limit = std::max(sheet.options.limit, before.distance(place));
    EXPECT_LE(after.distance(place), limit * (1 + 1e-9)) << place.transpose();
    lost += after.distance(place) > before.distance(place) + 1e-9 ? 1 : 0;
  }
  EXPECT_GT(lost, 0u) << "what may be lost is made use of";
  EXPECT_EQ(topology(mesh), (Topology{1, 0, 0}));
  for (const detail::ExactBall& ball : sheet.complex.balls) {
    EXPECT_TRUE(ball.exact);
    EXPECT_NEAR(ball.radius, 0.2, 1e-12);
    EXPECT_NEAR(ball.center.z(), 0.2, 1e-12);
  }
  const Shape shape = shape_of(mesh);
  EXPECT_GT(shape.mean_quality, std::max(0.8, old.mean_quality));
  EXPECT_EQ(shape.slivers, 0);
  EXPECT_EQ(shape.folds, 0);
  EXPECT_LE(shape.longest_edge, 4.0 / 3 * sheet.options.max_length * (1 + 1e-9));
  EXPECT_LT(mesh.size(), 0.6 * 20 * 20) << "it was finer than asked for";
}

TEST(Remesh, LeavesASheetAsItIsWhereNothingIsAskedFor) {
  ShakenSheet sheet;
  const detail::BallComplex before = sheet.complex;
  sheet.even_out(0);
  EXPECT_EQ(sheet.complex.triangles, before.triangles);
  EXPECT_EQ(sheet.complex.edges, before.edges);
  for (Index v = 0; v < before.size(); ++v) ASSERT_EQ(sheet.complex.balls[v].center, before.balls[v].center);
}

// ---- axes of solids

MedialBuildOptions remesh_options(Index points) {
  return {.sampling = {.face_points = points - points / 5, .edge_points = points / 5}, .refine = RefineOptions{}};
}

struct Limits {
  double mean_quality = 0.6, slivers = 0.03;
  double longest_edge = 4.0 / 3 * 0.03 * 1.4;  // diagonals; the factor is for those that may not be split
  double folds = 0;
};

MedialMesh expect_even(const TriangleMesh& solid, Index points, const Limits& limits = {}) {
  const Surface surface(solid);
  EXPECT_TRUE(surface.solid());
  const double length = diagonal(surface);
  const MedialBuild build = build_medial_axis(surface, remesh_options(points));
  EXPECT_TRUE(build.promise.kept()) << build.promise.open << " open, " << build.promise.protrusion << " sticking out";
  const MedialMesh mesh = medial_mesh(build.axis);
  EXPECT_EQ(topology(mesh), solid_topology(surface));
  for (Index v = 0; v < mesh.size(); ++v) {
    EXPECT_NEAR(mesh.radii[v], surface.distance(mesh.centers[v]), 1e-9 * length);
    EXPECT_LE(surface.signed_distance(mesh.centers[v]), 1e-9 * length);
  }
  EXPECT_LE(build.refinement.inexact, 0.03 * mesh.size());
  const Shape shape = shape_of(mesh);
  if (!mesh.triangles.empty()) {
    EXPECT_GE(shape.mean_quality, limits.mean_quality);
  }
  EXPECT_LE(shape.slivers, limits.slivers);
  EXPECT_LE(shape.folds, limits.folds);
  EXPECT_LE(shape.longest_edge, limits.longest_edge * length);
  return mesh;
}

using Profile = std::vector<std::array<double, 2>>;

// Two caps of spheres of radius 1, each up to an angle from its pole, moved apart.
Profile caps(double angle, double apart, int steps) {
  Profile profile;
  for (int i = 0; i <= 2 * steps + 1; ++i) {
    const int from_pole = i <= steps ? i : 2 * steps + 1 - i;
    const double side = i <= steps ? -1 : 1, at = angle * from_pole / steps;
    if (i == steps + 1 && !(apart > 0)) continue;
    profile.push_back({from_pole == 0 ? 0 : std::sin(at), side * (apart / 2 + std::cos(at) - std::cos(angle))});
  }
  return profile;
}

// A square of side 4 with a square hole.
TriangleMesh plate_with_hole() {
  TriangleMesh mesh;
  for (const double z : {0.0, 0.6}) {
    for (const double half : {2.0, 0.8}) {
      mesh.vertices.insert(mesh.vertices.end(),
                           {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
    }
  }
  const auto add = [&](Index a, Index b, Index c, Index d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (Index i = 0; i < 4; ++i) {
    const Index k = (i + 1) % 4;
    add(i, k, 8 + k, 8 + i);
    add(4 + k, 4 + i, 12 + i, 12 + k);
    add(8 + i, 8 + k, 12 + k, 12 + i);
    add(k, i, 4 + i, 4 + k);
  }
  return mesh;
}

// How much of the z axis bare edges are on, or nearly.
double curve_length(const MedialMesh& mesh, double tolerance) {
  double length = 0;
  for (const auto& [a, b] : bare_edges(mesh)) {
    const Point &start = mesh.centers[a], &end = mesh.centers[b];
    if (start.head<2>().norm() <= tolerance && end.head<2>().norm() <= tolerance)
      length += std::abs(end.z() - start.z());
  }
  return length;
}

// Flat sides: sheets alone.
void expect_even_sheets(const TriangleMesh& solid, Index points) {
  // Near corners, where the diagram's sheets are slit, some overlap.
  const MedialMesh mesh = expect_even(solid, points, {.folds = 0.01});
  EXPECT_TRUE(bare_edges(mesh).empty());
}

TEST(Remesh, OfABoxAndAPlateIsEven) {
  expect_even_sheets(test::known_box({1, 2, 3}).solid, 1000);
  expect_even_sheets(test::known_box({0.2, 2, 2}).solid, 600);
}

TEST(Remesh, OfAWedgeIsEven) { expect_even_sheets(test::extruded({{{0, 0}}, {{2, 0}}, {{0, 0.8}}}, 1.5), 600); }

TEST(Remesh, OfAnLIsEven) { expect_even_sheets(test::l_shape(), 600); }

TEST(Remesh, OfAPlateWithAHoleIsEvenAndHasItsLoop) { expect_even_sheets(plate_with_hole(), 1000); }

// Wider than tall: a disc between two truncated cones.
TEST(Remesh, OfACylinderWiderThanTallIsEven) {
  for (const int facets : {24, 64}) {
    SCOPED_TRACE(facets);
    const MedialMesh mesh = expect_even(test::turned({{2, 0}, {2, 0.8}}, facets), 600, {.folds = 0.002});
    EXPECT_TRUE(bare_edges(mesh).empty());
    EXPECT_LE(*std::max_element(mesh.radii.begin(), mesh.radii.end()), 0.4 + 1e-12);
  }
}

TEST(Remesh, OfAConeHasACurveTowardsItsApex) {
  const double largest = 3 / (1 + std::sqrt(10.0));  // ball, which touches the cone and its base
  const MedialMesh mesh = expect_even(test::turned({{1, 0}, {0, 3}}, 48), 1500, {.folds = 0.01});
  EXPECT_GT(curve_length(mesh, 0.002), 0.5 * (3 - largest));
}

// Taller than wide, with facets between which next to nothing is lost: a curve between two cones.
TEST(Remesh, OfACylinderTallerThanWideHasACurve) {
  const Surface surface(test::turned({{1, 0}, {1, 4}}, 64));
  const MedialBuild build = build_medial_axis(surface, remesh_options(600));
  const MedialMesh mesh = medial_mesh(build.axis);
  EXPECT_TRUE(build.promise.kept());
  EXPECT_EQ(topology(mesh), (Topology{1, 0, 0}));
  EXPECT_GT(shape_of(mesh).mean_quality, 0.6);
  EXPECT_GT(curve_length(mesh, 0.002), 1);  // of 2
}

TEST(Remesh, OfACapsuleIsACurve) {
  for (const double height : {2, 3}) {
    const MedialMesh mesh = expect_even(test::turned(caps(std::numbers::pi / 2, height, 12), 48), 500);
    EXPECT_TRUE(mesh.triangles.empty());
    double aside = 0;
    for (const Point& center : mesh.centers) aside = std::max(aside, center.head<2>().norm());
    EXPECT_LT(aside, 1e-6);
    EXPECT_NEAR(curve_length(mesh, 1e-6), height, 0.1);
  }
}

TEST(Remesh, OfALensIsADisc) {
  const MedialMesh mesh = expect_even(test::turned(caps(std::numbers::pi / 3, 0, 12), 48), 600);
  EXPECT_TRUE(bare_edges(mesh).empty());
  double farthest = 0;
  for (const Point& center : mesh.centers) {
    ASSERT_LT(std::abs(center.z()), 1e-9);
    farthest = std::max(farthest, center.head<2>().norm());
  }
  EXPECT_NEAR(farthest, std::sin(std::numbers::pi / 3), 0.002) << "up to its edge, which has corners";
}

// A cylinder wider than tall, which has sheets, a seam and borders on edges.
TEST(Remesh, IsTheSameWhateverTheThreadsAndThePowerOfTwo) {
  const TriangleMesh solid = test::turned({{2, 0}, {2, 0.8}}, 24);
  MedialBuildOptions options = remesh_options(400);
  options.check_promise = false;
  const auto build = [&](const TriangleMesh& mesh, std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return medial_mesh(build_medial_axis(Surface(mesh), options).axis);
  };
  const MedialMesh one = build(solid, 1), two = build(solid, 2),
                   large = build(test::transformed(solid, 4, Vector::Zero()), 2);
  EXPECT_EQ(one.centers, two.centers);
  EXPECT_EQ(one.radii, two.radii);
  EXPECT_EQ(one.triangles, two.triangles);
  EXPECT_EQ(one.triangles, large.triangles);
  ASSERT_EQ(one.size(), large.size());
  for (Index v = 0; v < one.size(); ++v) {
    ASSERT_EQ(Point(4 * one.centers[v]), large.centers[v]);
    ASSERT_EQ(4 * one.radii[v], large.radii[v]);
  }
}

}  // namespace
}  // namespace orchard
