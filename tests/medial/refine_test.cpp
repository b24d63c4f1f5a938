// The refined axis, judged by brute force over all triangles and by axes in closed form.
#include "orchard/medial/refine.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "outlines.h"
#include "support/shapes.h"

namespace orchard {
namespace {

MedialBuildOptions options_for(Index points, std::uint64_t seed = 1) {
  return {.sampling = {.face_points = points - points / 5, .edge_points = points / 5, .seed = seed},
          .refine = RefineOptions{}};
}

double diagonal(const Surface& surface) { return surface.bounding_box().diagonal().norm(); }

// The distance to the nearest of all triangles: no tree, no shortcut.
double brute_distance(const Surface& surface, const Point& query) {
  double min = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    min = std::min(min, closest_point_of_triangle(query, a, b, c).distance);
  }
  return min;
}

struct Solid {
  const char* name;
  TriangleMesh mesh;
  // The least share of exact balls. Those of the torus touch up to sixteen faces at once, which four contacts do not
  // decide.
  double exact = 0.97;
};

std::vector<Solid> solids() {
  return {{"box", test::known_box({1, 2, 3}).solid},
          {"L", test::known_l_shape(8).solid},
          {"cylinder", test::known_cylinder(24, 4).solid},
          {"torus", test::known_torus(32, 16).solid, 0.5},
          {"bridge", test::extruded(test::thin_bridge(0.05), 1)},
          {"notch", test::extruded(test::v_notch(0.2), 1)}};
}

TEST(RefineAxis, BallsTouchTheSurfaceAtTheirContactsAndHoldNothingOfIt) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const Surface surface(solid.mesh);
    const MedialBuild build = build_medial_axis(surface, options_for(500, 7));
    const MedialAxis& axis = build.axis;
    const double tolerance = 1e-9 * diagonal(surface);
    Index exact = 0;
    for (Index v = 0; v < axis.size(); ++v) {
      ASSERT_NEAR(axis.radii[v], brute_distance(surface, axis.centers[v]), tolerance);
      ASSERT_GE(axis.forming_points[v].size(), 1u);
      bool all = axis.forming_points[v].size() >= 2 || axis.radii[v] == 0;
      for (const Index contact : axis.forming_points[v]) {
        ASSERT_LT(brute_distance(surface, axis.points[contact]), tolerance);
        all = all && std::abs((axis.points[contact] - axis.centers[v]).norm() - axis.radii[v]) <= tolerance;
      }
      if (all) ++exact;
    }
    EXPECT_LE(axis.size() - exact, build.refinement.inexact);
    EXPECT_GT(exact, solid.exact * axis.size());
  }
}

TEST(RefineAxis, KeepsTheTopologyOfTheSolid) {
  for (const Solid& solid : solids()) {
    const Surface surface(solid.mesh);
    for (const Index points : {300u, 1000u}) {
      SCOPED_TRACE(std::string(solid.name) + ", " + std::to_string(points));
      const MedialMesh mesh = medial_mesh(build_medial_axis(surface, options_for(points)).axis);
      EXPECT_EQ(topology(mesh), solid_topology(surface));
    }
  }
}

TEST(RefineAxis, LiesOnTheClosedFormOfABoxAndReachesItsEdges) {
  const test::KnownAxis known = test::known_box({1, 2, 3});
  const Surface surface(known.solid);
  const MedialBuild build = build_medial_axis(surface, options_for(2000));
  const Surface sheets(test::as_triangles(known.axis));
  Index on_edges = 0;
  for (Index v = 0; v < build.axis.size(); ++v) {
    EXPECT_LT(sheets.distance(build.axis.centers[v]), 1e-6 * diagonal(surface));
    on_edges += build.axis.radii[v] == 0 ? 1 : 0;
  }
  EXPECT_EQ(on_edges, build.refinement.edge_vertices);
  EXPECT_GT(on_edges, 100u);
  // The borders are the box's twelve edges, 4 (1 + 2 + 3), with notches at the corners.
  EXPECT_NEAR(build.refinement.border_length * diagonal(surface), 24, 1.5);
  // Nothing of the closed form is farther from the axis than what a border may lose, and corners somewhat more.
  const Surface built(test::as_triangles(medial_mesh(build.axis)));
  for (const Point& place : test::points_on(known.axis, 0.05))
    EXPECT_LT(built.distance(place), 0.02 * diagonal(surface));
}

TEST(RefineAxis, LiesOnTheClosedFormOfAnLBesideItsParabolas) {
  const test::KnownAxis known = test::known_l_shape(64);
  const Surface surface(known.solid);
  const MedialBuild build = build_medial_axis(surface, options_for(2000));
  const Surface sheets(test::as_triangles(known.axis));
  Index astray = 0;
  for (Index v = 0; v < build.axis.size(); ++v) {
    const Point& center = build.axis.centers[v];
    // What touches the reentrant edge is on parabolas and the cone of the roofs, which the closed form has in chords.
    if (std::abs((center - Point(1, 1, center.z())).norm() - build.axis.radii[v]) < 1e-6) continue;
    const double off = sheets.distance(center);
    if (off > 1e-6 * diagonal(surface)) ++astray;
    EXPECT_LT(off, 0.01 * diagonal(surface)) << center.transpose();
  }
  EXPECT_LE(astray, build.refinement.inexact);
  EXPECT_LT(build.refinement.inexact, 0.02 * build.axis.size());
}

TEST(RefineAxis, InterpolatedBallsAreRightUpToTheTolerance) {
  const Surface surface(test::known_l_shape(8).solid);
  for (const double tolerance : {2e-3, 5e-4}) {
    MedialBuildOptions options = options_for(500);
    options.refine->tolerance = tolerance;
    const MedialBuild build = build_medial_axis(surface, options);
    EXPECT_EQ(build.refinement.undivided, 0u);
    const MedialMesh mesh = medial_mesh(build.axis);
    for (const auto& [a, b] : mesh.edges) {
      for (const double t : {0.25, 0.5, 0.75}) {
        const double radius = (1 - t) * mesh.radii[a] + t * mesh.radii[b];
        const double distance = brute_distance(surface, (1 - t) * mesh.centers[a] + t * mesh.centers[b]);
        EXPECT_NEAR(radius, distance, 1.5 * tolerance * diagonal(surface));
      }
    }
  }
}

double area(const MedialMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += (mesh.centers[b] - mesh.centers[a]).cross(mesh.centers[c] - mesh.centers[a]).norm() / 2;
  return sum;
}

TEST(RefineAxis, LessBorderLossGivesLargerSheets) {
  const Surface surface(test::known_box({1, 2, 3}).solid);
  double last = 0;
  for (const double loss : {3e-2, 1e-2, 3e-3}) {
    MedialBuildOptions options = options_for(1000);
    options.refine->border_loss = loss;
    options.refine->sharp_angle = 3;  // no edges to reach
    const double now = area(medial_mesh(build_medial_axis(surface, options).axis));
    EXPECT_GT(now, last);
    last = now;
  }
}

TEST(RefineAxis, IsTheSameWhateverTheThreadsAndThePowerOfTwo) {
  TriangleMesh mesh = test::known_l_shape(8).solid;
  const Surface surface(mesh);
  const MedialBuild build = build_medial_axis(surface, options_for(800));
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const MedialBuild again = build_medial_axis(surface, options_for(800));
    EXPECT_EQ(again.axis.centers, build.axis.centers);
    EXPECT_EQ(again.axis.radii, build.axis.radii);
    EXPECT_EQ(again.axis.faces.items, build.axis.faces.items);
  }
  for (Point& vertex : mesh.vertices) vertex *= 1024;
  const MedialBuild large = build_medial_axis(Surface(mesh), options_for(800));
  ASSERT_EQ(large.axis.size(), build.axis.size());
  EXPECT_EQ(large.axis.faces.items, build.axis.faces.items);
  for (Index v = 0; v < build.axis.size(); ++v) ASSERT_EQ(large.axis.centers[v], Point(1024 * build.axis.centers[v]));
}

TEST(RefineAxis, RefusesOptionsOutOfRange) {
  const Surface surface(test::known_box({1, 2, 3}).solid);
  const auto refused = [&](const RefineOptions& refine) {
    MedialBuildOptions options = options_for(100);
    options.refine = refine;
    EXPECT_THROW(build_medial_axis(surface, options), InputError);
  };
  refused({.border_loss = -1});
  refused({.border_loss = std::numeric_limits<double>::quiet_NaN()});
  refused({.tolerance = 0});
  refused({.sharp_angle = 4});
  refused({.max_rounds = -1});
}

}  // namespace
}  // namespace orchard
