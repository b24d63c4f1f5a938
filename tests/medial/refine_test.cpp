// The refined axis, judged by brute force over all triangles and by axes in closed form: one property a test, hence
// more than 300 lines.
#include "orchard/medial/refine.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "balls/found_balls.h"
#include "extend/free_extension.h"
#include "hanging_pieces.h"
#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/outside_solid.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "outlines.h"
#include "quality/reconstruction.h"
#include "support.h"
#include "support/brute_distance.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

MedialBuildOptions options_for(Index points, std::uint64_t seed = 1) {
  return {.sampling = {.face_points = points - points / 5, .edge_points = points / 5, .seed = seed},
          .refine = RefineOptions{}};
}

using test::diagonal;

struct Solid {
  const char* name;
  TriangleMesh mesh;
  // The least share of exact balls. Those of the torus touch up to sixteen faces at once, and those in the middle of
  // the cylinder 24, which four contacts do not decide.
  double exact = 0.97;
};

std::vector<Solid> solids() {
  return {{"box", test::known_box({1, 2, 3}).solid},
          {"L", test::known_l_shape(8).solid},
          {"cylinder", test::known_cylinder(24, 4).solid, 0.84},
          {"torus", test::known_torus(32, 16).solid, 0.5},
          {"bridge", test::extruded(test::thin_bridge(0.05), 1)},
          {"groove", test::extruded(test::v_groove(0.2), 1)}};
}

// Between a sphere and the one around it that is twice as large: the sphere half way.
TEST(RefineAxis, OfTheSpaceAroundASphereIsTheSphereHalfWay) {
  const Surface sphere(test::icosphere(4));
  const Surface outside(outside_solid(sphere, 2));
  MedialBuildInput input;
  input.sampling = sample_outside(sphere, outside, {.face_points = 800, .edge_points = 0});
  const MedialBuild build = build_medial_axis(outside, options_for(1000), {}, std::move(input));
  const MedialMesh mesh = medial_mesh(build.axis);
  EXPECT_EQ(topology(mesh), (Topology{1, 0, 1}));
  for (Index v = 0; v < mesh.size(); ++v) {
    EXPECT_NEAR(mesh.centers[v].norm(), 1.5, 0.02);  // both are meshes, whose facets are below them by .005
    EXPECT_NEAR(mesh.radii[v], 0.5, 0.02);
  }
}

TEST(RefineAxis, BallsTouchTheSurfaceAtTheirContactsAndHoldNothingOfIt) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const Surface surface(solid.mesh);
    const MedialBuild build = build_medial_axis(surface, options_for(300, 7));
    const MedialAxis& axis = build.axis;
    const double tolerance = 1e-9 * diagonal(surface);
    Index exact = 0;
    for (Index v = 0; v < axis.size(); ++v) {
      ASSERT_NEAR(axis.radii[v], test::brute_distance(surface, axis.centers[v]), tolerance);
      ASSERT_GE(axis.forming_points[v].size(), 1u);
      bool all = axis.forming_points[v].size() >= 2 || axis.radii[v] == 0;
      for (const Index contact : axis.forming_points[v]) {
        ASSERT_LT(test::brute_distance(surface, axis.points[contact]), tolerance);
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
    for (const Index points : test::more() > 1 ? std::vector<Index>{1000, 3000} : std::vector<Index>{300}) {
      SCOPED_TRACE(std::string(solid.name) + ", " + std::to_string(points));
      const MedialMesh mesh = medial_mesh(build_medial_axis(surface, options_for(points)).axis);
      EXPECT_EQ(topology(mesh), solid_topology(surface));
    }
  }
}

bool ends_at(const MedialAxis& axis, const Point& place) {
  for (Index v = 0; v < axis.size(); ++v) {
    if (axis.radii[v] == 0 && (axis.centers[v] - place).norm() < 1e-9) return true;
  }
  return false;
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
  // The borders are the box's twelve edges, 4 (1 + 2 + 3), and slits next to some corners.
  EXPECT_NEAR(build.refinement.border_length * diagonal(surface), 24, 0.6);
  for (const Point& corner : surface.mesh().vertices) EXPECT_TRUE(ends_at(build.axis, corner));
  // All of the closed form is there, but for the width of what is coalesced at its seams.
  const Surface built(test::as_triangles(medial_mesh(build.axis)));
  for (const Point& place : test::points_on(known.axis, 0.05))
    EXPECT_LT(built.distance(place), 1e-5 * diagonal(surface)) << place.transpose();
}

// Between its parallel faces the points are farther apart than it is thick.
TEST(RefineAxis, ReachesTheEdgesOfAPlateThatIsThinnerThanThePointsSpacing) {
  const test::KnownAxis known = test::known_box({0.02, 1, 2});
  const Surface surface(known.solid);
  MedialBuildOptions options = options_for(400);
  options.refine->feature_loss = 1e-3;  // its edges lose little beside the diagonal: 0.2 %
  const MedialBuild build = build_medial_axis(surface, options);
  EXPECT_EQ(topology(medial_mesh(build.axis)), solid_topology(surface));
  const Surface built(test::as_triangles(medial_mesh(build.axis)));
  Index missed = 0;
  const std::vector<Point> places = test::points_on(known.axis, 0.01);
  for (const Point& place : places) missed += built.distance(place) > 1e-3 * diagonal(surface) ? 1 : 0;
  EXPECT_LT(missed, 0.03 * static_cast<double>(places.size()));
}

// How far a place of the surface is from all balls, in the mean over the corners of small triangles.
double mean_gap(const Surface& surface, const MedialAxis& axis) {
  const MedialMesh mesh = medial_mesh(axis);
  const detail::Reconstruction reconstruction(mesh);
  const SurfaceSampling places =
      sample_surface(surface, {.face_points = 4000, .edge_points = 0, .iterations = 0, .seed = 5});
  double sum = 0;
  for (const Point& place : places.points) sum += std::max(reconstruction.distance(place), 0.0);
  return sum / places.size();
}

// Where the points see only strips of the sheets between a bar's middle and its edges, what is between these is filled.
TEST(RefineAxis, SheetsOfABarThinnerThanThePointsSpacingAreNotTorn) {
  for (const Vector& size : {Vector(10, 0.25, 0.2), Vector(10, 0.2, 0.2), Vector(8, 0.3, 0.15)}) {
    const Surface bar(test::box(Point::Zero(), size));
    const double edges = 4 * size.sum(), diagonal = bar.bounding_box().diagonal().norm();
    for (std::uint64_t seed = 1; seed <= 3 * test::more(); ++seed) {
      SCOPED_TRACE(seed);
      const MedialBuild build = build_medial_axis(
          bar, {.sampling = {.face_points = 300, .edge_points = 0, .seed = test::first_seed() + seed},
                .refine = RefineOptions{.feature_loss = 2e-3}});  // all of their edges lose more than that
      EXPECT_EQ(topology(medial_mesh(build.axis)), (Topology{1, 0, 0}));
      const double length = build.refinement.border_length * diagonal;
      // Torn into strips they had more than twice as much.
      EXPECT_GT(length, 0.95 * edges);
      EXPECT_LT(length, 1.7 * edges);
    }
  }
}

TEST(RefineAxis, NoPieceHangsByOneVertexWithinItsReach) {
  for (const Solid& solid : solids()) {
    const Surface surface(solid.mesh);
    for (std::uint64_t seed = 1; seed <= test::more(); ++seed) {
      SCOPED_TRACE(solid.name + (" " + std::to_string(seed)));
      const MedialBuild build = build_medial_axis(surface, options_for(500, test::first_seed() + seed));
      EXPECT_EQ(test::hanging_pieces(medial_mesh(build.axis), 2), 0u);
    }
  }
}

TEST(RefineAxis, PointsAtOpenPlacesCloseThem) {
  const Surface surface(test::extruded(test::thin_bridge(0.05), 1));
  MedialBuildOptions options = options_for(300);
  options.open_rounds = 0;
  const MedialBuild first = build_medial_axis(surface, options);
  EXPECT_EQ(first.open_places, 0u);
  options.open_rounds = 2;
  const MedialBuild closed = build_medial_axis(surface, options);
  EXPECT_GT(closed.open_places, 0u);
  std::set<std::string> stages;
  for (const auto& [stage, seconds] : closed.seconds) EXPECT_TRUE(stages.insert(stage).second) << stage;
  EXPECT_EQ(closed.points, first.points);
  EXPECT_EQ(closed.sampling.size(), closed.points + closed.open_places + closed.gap_repair.points_added);
  EXPECT_LT(mean_gap(surface, closed.axis), 0.9 * mean_gap(surface, first.axis));
  EXPECT_EQ(topology(medial_mesh(closed.axis)), solid_topology(surface));
}

TEST(RefineAxis, RepairPassesAreThoseOfTheLastRound) {
  const Surface surface(test::extruded(test::thin_bridge(0.05), 1));
  MedialBuildOptions options = options_for(300);
  options.open_rounds = 2;
  const MedialBuild build = build_medial_axis(surface, options);
  ASSERT_GT(build.open_places, 0u);
  ASSERT_FALSE(build.gap_repair.passes.empty());
  std::vector<int> expected(build.sampling.size(), 0);
  std::size_t at = 0;
  for (; at < expected.size(); ++at) expected[at] = build.sampling.origins[at] == PointOrigin::repair ? -1 : 0;
  for (std::size_t pass = build.gap_repair.passes.size(); pass-- > 0;) {
    const GapRepairPass& made = build.gap_repair.passes[pass];
    for (Index i = made.added_by_projection + made.added_by_snapping + made.added_at_necks; i > 0; --i)
      expected[--at] = static_cast<int>(pass + 1);
  }
  EXPECT_LT(build.points, at) << "points of earlier rounds lie between";
  EXPECT_EQ(repair_passes(build), expected);
}

// Later rounds take balls from earlier ones.
TEST(RefineAxis, OfSeveralRoundsIsThatOfTheirLastDiagram) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 2 * test::more(); ++seed) {
    SCOPED_TRACE(seed);
    const Surface surface(test::extruded(test::thin_bridge(0.05), 1));
    MedialBuildOptions options = options_for(300);
    options.sampling.seed = seed;
    options.open_rounds = 2;
    const MedialBuild rounds = build_medial_axis(surface, options);
    ASSERT_GT(rounds.open_places, 0u);
    MedialBuildInput last;
    last.diagram = {rounds.diagram, rounds.sampling};
    const MedialBuild once = build_medial_axis(surface, options, {}, last);
    EXPECT_EQ(rounds.axis.centers, once.axis.centers);
    EXPECT_EQ(rounds.axis.radii, once.axis.radii);
    EXPECT_EQ(rounds.axis.faces.items, once.axis.faces.items);
  }
}

TEST(FoundBalls, AreFoundByTheirStartAndAllSeeds) {
  std::mt19937 random(static_cast<unsigned>(test::first_seed()));
  const auto number = [&] { return static_cast<double>(random() % 5); };  // many are the same
  const auto contact = [&] {
    ClosestPoint place = detail::ExactBall::nowhere();
    place.position = {number(), 0, 0};
    place.triangle = random() % 2;
    return place;
  };
  struct Known {
    Point start;
    std::vector<ClosestPoint> seeds;
    double radius;
  };
  detail::FoundBalls found;
  std::vector<Known> all;
  const auto is_same = [](const ClosestPoint& a, const ClosestPoint& b) {
    return a.position == b.position && a.triangle == b.triangle;
  };
  for (int i = 0; i < 5'000; ++i) {
    Known asked{.start = {number(), number(), number()}, .seeds = {}, .radius = i + 1.0};
    for (auto count = random() % 4; count > 0; --count) asked.seeds.push_back(contact());
    const auto same = std::find_if(all.begin(), all.end(), [&](const Known& other) {
      return other.start == asked.start &&
             std::equal(other.seeds.begin(), other.seeds.end(), asked.seeds.begin(), asked.seeds.end(), is_same);
    });
    const detail::ExactBall* ball = found.find(asked.start, asked.seeds);
    ASSERT_EQ(ball != nullptr, same != all.end()) << i;
    if (ball) {
      ASSERT_EQ(ball->radius, same->radius) << i;
      continue;
    }
    detail::ExactBall made;
    made.radius = asked.radius;
    found.add(asked.start, asked.seeds, made);
    all.push_back(asked);
  }
  EXPECT_GT(all.size(), 500u);
  EXPECT_LT(all.size(), 5'000u);
}

TEST(RefineAxis, OwnPointsAreLeftAsTheyAre) {
  const Surface surface(test::extruded(test::thin_bridge(0.05), 1));
  MedialBuildOptions options = options_for(300);
  MedialBuildInput own;
  own.sampling = sample_surface(surface, options.sampling);
  EXPECT_EQ(build_medial_axis(surface, options, {}, own).open_places, 0u);
}

// Random triangles over few vertices, most of which would close loops or cavities.
TEST(FreeExtension, TakesNoTriangleThatChangesTheTopology) {
  std::mt19937 random(20);
  Index taken = 0, refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    detail::BallComplex complex;
    for (int i = 0; i < 5; ++i) complex.balls.push_back({.center = Point(i, i * i, i * i * i), .radius = 1});
    complex.triangles = {{0, 1, 2}, {1, 2, 3}};
    complex.edges = {{3, 4}};
    complex.complete();
    const auto topology_of = [](const detail::BallComplex& cells) {
      MedialMesh mesh;
      for (const detail::ExactBall& ball : cells.balls) {
        mesh.centers.push_back(ball.center);
        mesh.radii.push_back(ball.radius);
      }
      mesh.edges = cells.edges;
      mesh.triangles = cells.triangles;
      return topology(mesh);
    };
    const Topology before = topology_of(complex);
    detail::FreeExtension extension(complex);
    for (int i = 0; i < 4; ++i) extension.add_vertex({.center = Point(-i, i, 7), .radius = 1});
    std::uniform_int_distribution<Index> any(0, complex.size() - 1);
    for (int i = 0; i < 30; ++i) {
      if (extension.add(any(random), any(random), any(random))) {
        ++taken;
      } else {
        ++refused;
      }
    }
    extension.finish();
    ASSERT_EQ(topology_of(complex), before) << trial;
  }
  EXPECT_GT(taken, 200u);
  EXPECT_GT(refused, 2000u);
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
        const double distance = test::brute_distance(surface, (1 - t) * mesh.centers[a] + t * mesh.centers[b]);
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
    options.refine->feature_loss = 1;  // no edges to reach
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
    options.refine.emplace(refine);
    EXPECT_THROW(build_medial_axis(surface, options), InputError);
  };
  refused({.border_loss = -1});
  refused({.border_loss = std::numeric_limits<double>::quiet_NaN()});
  refused({.tolerance = 0});
  refused({.feature_loss = 0});
  refused({.feature_loss = std::numeric_limits<double>::infinity()});
  refused({.feature_length = -1});
  refused({.max_rounds = -1});
}

}  // namespace
}  // namespace orchard
