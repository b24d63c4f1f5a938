#include "orchard/medial/segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "quality/reconstruction.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// A strip of two quadrilaterals, a flap on the line between them, and a tail of two edges. Vertices:
//   0 1 2 along the top, 3 4 5 along the bottom, 6 7 the flap's free corners over 1 4, 8 9 the tail from 5.
MedialAxis strip_with_flap_and_tail() {
  MedialAxis axis;
  axis.centers = {{0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {0, 0, 0}, {1, 0, 0},
                  {2, 0, 0}, {1, 1, 1}, {1, 0, 1}, {3, 0, 0}, {4, 0, 0}};
  axis.radii = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.05, 0.05, 0.4, 0.3};
  axis.points = {{1, 0.5, 5}, {1, 0.5, -5}, {6, 0.5, 0.5}, {-4, 0.5, 0.5}};
  axis.origins.assign(4, PointOrigin::face);
  const std::vector<std::vector<Index>> neighbors{{1, 3},    {0, 2, 4, 6}, {1, 5}, {0, 4}, {1, 3, 5, 7},
                                                  {2, 4, 8}, {1, 7},       {4, 6}, {5, 9}, {8}};
  for (const auto& row : neighbors) {
    axis.neighbors.items.insert(axis.neighbors.items.end(), row.begin(), row.end());
    axis.neighbors.close_row();
    axis.forming_points.items.insert(axis.forming_points.items.end(), {0, 1, 2, 3});
    axis.forming_points.close_row();
  }
  for (const std::vector<Index>& face : {std::vector<Index>{0, 1, 4, 3}, {1, 2, 5, 4}, {1, 6, 7, 4}}) {
    axis.faces.items.insert(axis.faces.items.end(), face.begin(), face.end());
    axis.faces.close_row();
  }
  axis.face_points = {{0, 1}, {0, 1}, {2, 3}};
  return axis;
}

TEST(MedialSegments, EndAtJunctionsAndTellSheetsFromCurves) {
  const MedialAxis axis = strip_with_flap_and_tail();
  const MedialSegments found = medial_segments(axis, {.touching = 0.01});
  ASSERT_EQ(found.segments.size(), 4u);  // three sheets at the junction, and the tail
  EXPECT_TRUE(found.segments[0].has_faces && found.segments[1].has_faces && found.segments[2].has_faces);
  EXPECT_FALSE(found.segments[3].has_faces);
  EXPECT_EQ(found.segments[3].cells, 2u);
  EXPECT_EQ(found.of_face, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(found.of_vertex[0], 0u);
  EXPECT_EQ(found.of_vertex[2], 1u);
  EXPECT_EQ(found.of_vertex[6], 2u);
  EXPECT_EQ(found.of_vertex[9], 3u);
}

TEST(MedialSegments, AreBranchesWhereTheyNearlyTouchTheSurface) {
  const MedialAxis axis = strip_with_flap_and_tail();
  const MedialSegments far = medial_segments(axis, {.touching = 0.01});
  for (const auto& segment : far.segments) EXPECT_TRUE(segment.trunk);
  const MedialSegments near = medial_segments(axis, {.touching = 0.1});
  // What never gets away from the surface is no sheet of its own: the flap makes its neighbour a branch.
  ASSERT_EQ(near.segments.size(), 3u);
  EXPECT_FALSE(near.segments[0].trunk);
  EXPECT_TRUE(near.segments[1].trunk);
  EXPECT_TRUE(near.segments[2].trunk);
}

TEST(StructureGraph, HasBordersJunctionsAndCurves) {
  const MedialAxis axis = strip_with_flap_and_tail();
  const StructureGraph graph = structure_graph(axis);
  int count[3] = {0, 0, 0};
  double length = 0;
  for (const auto& arc : graph.arcs) {
    ++count[static_cast<int>(arc.kind)];
    length += arc.length;
    EXPECT_EQ(graph.nodes[arc.from], arc.vertices.front());
    EXPECT_EQ(graph.nodes[arc.to], arc.vertices.back());
  }
  EXPECT_EQ(count[0], 1);  // the tail
  EXPECT_EQ(count[2], 1);  // between 1 and 4
  EXPECT_EQ(count[1], 4);  // around 0 3, over 6 7, 1 to 2 to 5, and 4 to 5, where the tail ends the line
  EXPECT_NEAR(length, 2 + 1 + 6 + 3, 1e-12);
  EXPECT_EQ(graph.nodes, (std::vector<Index>{1, 4, 5, 9}));
}

TEST(StructureGraph, OfAClosedLineHasOneNode) {
  MedialAxis axis;
  axis.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  axis.radii = {1, 1, 1};
  for (const std::array<Index, 2>& row : {std::array<Index, 2>{1, 2}, {0, 2}, {0, 1}}) {
    axis.neighbors.items.insert(axis.neighbors.items.end(), row.begin(), row.end());
    axis.neighbors.close_row();
  }
  const StructureGraph graph = structure_graph(axis);
  ASSERT_EQ(graph.arcs.size(), 1u);
  EXPECT_EQ(graph.nodes.size(), 1u);
  EXPECT_EQ(graph.arcs[0].vertices.size(), 4u);
  const std::string xml = to_graphml(graph, axis);
  EXPECT_NE(xml.find("<edge source=\"n0\" target=\"n0\">"), std::string::npos);
  EXPECT_EQ(std::count(xml.begin(), xml.end(), '<'), std::count(xml.begin(), xml.end(), '>'));
}

TEST(MedialSegments, OfABoxAreItsThirteenSheets) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const MedialAxis axis = build_medial_axis(surface, {.sampling = {.face_points = 3200, .edge_points = 800}}).axis;
  const double spacing = std::sqrt(surface.report().area / 4000);
  const MedialSegments found = medial_segments(axis, {.touching = 2 * spacing});
  const Index cells = axis.faces.size() + axis.topology_faces.size();
  Index large = 0, trunks = 0;
  for (const auto& segment : found.segments) {
    if (100 * segment.cells < cells) continue;
    ++large;
    trunks += segment.trunk ? 1 : 0;
    if (segment.trunk) {
      EXPECT_NEAR(segment.min_radius, 0.5, 0.05);
    }
  }
  EXPECT_EQ(large, 13u);
  EXPECT_EQ(trunks, 1u);
}

// Against all balls of a fine grid on the cell.
TEST(NearestBall, IsTheLeastOverTheCell) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 77);
    const auto point = [&] { return Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    std::array<Sphere, 3> balls;
    for (Sphere& ball : balls) ball = {point(), random.uniform(0, seed % 3 == 0 ? 2.0 : 0.4)};
    if (seed % 7 == 0) balls[2] = balls[1];                                           // a segment
    if (seed % 11 == 0) balls[2].center = 0.5 * (balls[0].center + balls[1].center);  // corners on a line
    const Point query = 2 * point();
    const auto value = [&](const Sphere& ball) { return (query - ball.center).norm() - ball.radius; };
    double min = 1e9;
    constexpr int kSteps = 60;
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; i + k <= kSteps; ++k) {
        const double u = double(i) / kSteps, v = double(k) / kSteps, w = 1 - u - v;
        min = std::min(min, value({w * balls[0].center + u * balls[1].center + v * balls[2].center,
                                   w * balls[0].radius + u * balls[1].radius + v * balls[2].radius}));
      }
    }
    const double found = value(detail::nearest_ball(query, balls[0], balls[1], balls[2]));
    EXPECT_LE(found, min + 1e-9) << seed;
    EXPECT_GE(found, min - 0.02) << seed;
  }
}

TEST(Reconstruction, FindsTheNearestOfAllCells) {
  MedialMesh mesh;
  for (Index i = 0; i < 60; ++i) {
    Random random(3, i);
    mesh.centers.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    mesh.radii.push_back(random.uniform(0, 0.3));
  }
  for (Index i = 0; i + 2 < 40; i += 2) mesh.triangles.push_back({i, i + 1, i + 2});
  for (Index i = 40; i + 1 < 55; ++i) mesh.edges.push_back({i, i + 1});
  complete(mesh);
  const detail::Reconstruction reconstruction(mesh);
  const auto ball = [&](Index i) { return Sphere{mesh.centers[i], mesh.radii[i]}; };
  for (Index i = 0; i < 200; ++i) {
    Random random(4, i);
    const Point query(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
    double min = 1e9;
    const auto take = [&](const Sphere& s) { min = std::min(min, (query - s.center).norm() - s.radius); };
    for (Index v = 0; v < mesh.size(); ++v) take(ball(v));
    for (const auto& [a, b] : mesh.edges) take(detail::nearest_ball(query, ball(a), ball(b)));
    for (const auto& [a, b, c] : mesh.triangles) take(detail::nearest_ball(query, ball(a), ball(b), ball(c)));
    EXPECT_NEAR(reconstruction.distance(query), min, 1e-12);
    const detail::Reconstruction::Nearest nearest = reconstruction.nearest(query);
    EXPECT_NEAR(nearest.distance, min, 1e-12);
    EXPECT_NEAR(reconstruction.distance_to_cell(nearest.cell, query), min, 1e-12);
    const auto& corners = reconstruction.corners_of(nearest.cell);
    const bool is_vertex = corners[0] == corners[1], is_edge = !is_vertex && corners[1] == corners[2];
    const Sphere found = is_vertex ? ball(corners[0])
                         : is_edge ? detail::nearest_ball(query, ball(corners[0]), ball(corners[1]))
                                   : detail::nearest_ball(query, ball(corners[0]), ball(corners[1]), ball(corners[2]));
    EXPECT_NEAR((query - found.center).norm() - found.radius, min, 1e-12);
    EXPECT_LT(reconstruction.nearest(query, min + 0.2).distance, min + 0.2);
  }
}

// Sheets, crumbs, coincident and huge balls, in any size and place; from centres of boxes, near and far.
TEST(Reconstruction, FindsTheNearestInTreesOfAnyShape) {
  const auto cases = 60 * test::more();
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + cases; ++seed) {
    Random random(seed, 78);
    const double size = std::pow(10, random.uniform(-6, 6));
    const auto point = [&] { return Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    const Vector offset = (seed % 3 == 0 ? 100.0 : 0.0) * point();
    MedialMesh mesh;
    const auto count = static_cast<Index>(1 + random.below(seed % 5 == 0 ? 6 : 400));
    for (Index i = 0; i < count; ++i) {
      Point center = point();
      if (seed % 2 == 0) center.z() = 0.1 * center.x() * center.y();
      if (i > 0 && random.below(20) == 0) center = (mesh.centers.back() - size * offset) / size;
      mesh.centers.push_back(size * (center + offset));
      mesh.radii.push_back(size * random.uniform(0, random.below(50) == 0 ? 3.0 : 0.2));
    }
    for (Index i = 0; i + 2 < count / 2; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
    for (Index i = count / 2; i + 1 < count; i += 2) mesh.edges.push_back({i, i + 1});
    complete(mesh);
    const detail::Reconstruction reconstruction(mesh);
    for (int i = 0; i < 30; ++i) {
      Point query = size * (1.5 * point() + offset);
      if (i % 5 == 0) query = mesh.centers[random.below(count)];
      if (i == 1) query = size * 1e7 * point();
      if (i == 2) query = size * 1e18 * point();
      double min = std::numeric_limits<double>::infinity();
      for (Index cell = 0; cell < reconstruction.cells(); ++cell)
        min = std::min(min, reconstruction.distance_to_cell(cell, query));
      const double rounding = 1e-14 * (std::abs(min) + query.norm() + 100 * size);
      ASSERT_NEAR(reconstruction.distance(query), min, rounding) << "seed " << seed << ", query " << i;
    }
  }
}

// Cells and vertices come, go, and move, more than once.
TEST(Reconstruction, AfterChangesIsThatOfTheMeshAsItIs) {
  const auto cases = 60 * test::more();
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + cases; ++seed) {
    Random random(seed, 79);
    const auto point = [&] { return Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    MedialMesh mesh;
    const auto add_vertices = [&](Index count) {
      for (Index i = 0; i < count; ++i) {
        mesh.centers.push_back(point());
        mesh.radii.push_back(random.uniform(0, 0.2));
      }
    };
    const auto any_vertex = [&] { return static_cast<Index>(random.below(mesh.size())); };
    const auto add_cells = [&](Index count) {
      for (Index i = 0; i < count; ++i) {
        const Index a = any_vertex(), b = any_vertex(), c = any_vertex();
        if (a == b || b == c || a == c) continue;
        if (random.below(3) == 0) {
          mesh.edges.push_back({a, b});
        } else {
          mesh.triangles.push_back({a, b, c});
        }
      }
    };
    add_vertices(seed % 7 == 0 ? 0 : static_cast<Index>(1 + random.below(60)));
    if (mesh.size() > 0) add_cells(static_cast<Index>(random.below(60)));
    complete(mesh);
    detail::Reconstruction reconstruction(mesh);
    for (int change = 0; change < 4; ++change) {
      add_vertices(static_cast<Index>(random.below(5) + (mesh.size() == 0 ? 1 : 0)));
      add_cells(static_cast<Index>(random.below(8)));
      complete(mesh);
      if (random.below(2) == 0 && !mesh.triangles.empty()) mesh.triangles.erase(mesh.triangles.begin());
      if (random.below(3) == 0) mesh.radii[any_vertex()] *= 0.5;
      if (random.below(3) == 0) mesh.centers[any_vertex()] = point();
      reconstruction.change(mesh);
      const detail::Reconstruction fresh(mesh);
      for (int i = 0; i < 30; ++i) {
        const Point query = 1.5 * point();
        const detail::Reconstruction::Nearest nearest = reconstruction.nearest(query);
        ASSERT_NEAR(nearest.distance, fresh.distance(query), 1e-12) << "seed " << seed << ", change " << change;
        ASSERT_NEAR(nearest.distance, reconstruction.distance_to_cell(nearest.cell, query), 1e-12) << "seed " << seed;
        const auto& [a, b, c] = reconstruction.corners_of(nearest.cell);
        MedialMesh cell{.centers = {mesh.centers[a], mesh.centers[b], mesh.centers[c]},
                        .radii = {mesh.radii[a], mesh.radii[b], mesh.radii[c]},
                        .edges = {},
                        .triangles = {{0, 1, 2}}};
        complete(cell);
        ASSERT_NEAR(nearest.distance, detail::Reconstruction(cell).distance(query), 1e-12) << "seed " << seed;
      }
    }
  }
}

// So what holds at the corners of a triangle holds on all of it.
TEST(Reconstruction, DistanceToOneCellIsConvex) {
  const auto cases = static_cast<Index>(2'000 * test::more());
  for (Index i = 0; i < cases; ++i) {
    Random random(test::first_seed() + 5, i);
    const auto place = [&](double size) {
      return Point(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    };
    MedialMesh mesh;
    const Index corners = 1 + i % 3;
    // Flat and tiny cells, and balls in balls, too.
    const double size = i % 5 == 0 ? 1e-6 : 1, radius = i % 7 == 0 ? 3 : 0.5;
    for (Index v = 0; v < corners; ++v) {
      mesh.centers.push_back(place(size));
      mesh.radii.push_back(random.uniform(0, radius));
    }
    if (i % 11 == 0 && corners == 3) mesh.centers[2] = 0.25 * mesh.centers[0] + 0.75 * mesh.centers[1];
    if (corners == 2) mesh.edges.push_back({0, 1});
    if (corners == 3) mesh.triangles.push_back({0, 1, 2});
    complete(mesh);
    const detail::Reconstruction reconstruction(mesh);
    const std::array<Point, 3> at{place(2), place(2), place(2)};
    double max = -1e9;
    for (const Point& corner : at) max = std::max(max, reconstruction.distance_to_cell(0, corner));
    for (int k = 0; k < 20; ++k) {
      const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
      EXPECT_LE(reconstruction.distance_to_cell(0, u * at[0] + v * at[1] + (1 - u - v) * at[2]), max + 1e-9) << i;
    }
  }
}

}  // namespace
}  // namespace orchard
