// The medial mesh in few balls: its topology, closed forms, limits, and its error beside brute force; one property a
// test, hence more than 300 lines.
#include "orchard/medial/simplify.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "orchard/medial/topology.h"
#include "quality/boundary_reach.h"
#include "quality/reconstruction.h"
#include "simplify/contractible_mesh.h"
#include "simplify/fit.h"
#include "simplify/foot.h"
#include "simplify/least_vertices.h"
#include "simplify/protrusions.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using detail::Ball4;
using detail::ContractibleMesh;

// A raw axis where the test is of what contraction does, whose result is of any mesh: it has fewer vertices, and is
// there sooner.
MedialMesh built_axis(const Surface& surface, Index points, bool refined = true) {
  MedialBuildOptions options{.sampling = {.face_points = points - points / 5, .edge_points = points / 5}};
  if (refined) options.refine.emplace();
  return medial_mesh(build_medial_axis(surface, options).axis);
}

// An icosphere whose halves are moved apart along z.
TriangleMesh capsule(double length) {
  TriangleMesh mesh = test::icosphere(3);
  for (Point& vertex : mesh.vertices)
    vertex.z() += vertex.z() > 1e-9 ? length / 2 : vertex.z() < -1e-9 ? -length / 2 : 0;
  return mesh;
}

TEST(SimplifiedMedialMesh, IsTwoBallsForACapsule) {
  const Surface surface(capsule(3));
  MedialMesh chain;
  for (Index v = 0; v < 40; ++v) {
    chain.centers.emplace_back(0, 0, -1.5 + 3.0 * v / 39);
    chain.radii.push_back(1);
    if (v > 0) chain.edges.push_back({v - 1, v});
  }
  complete(chain);
  const SimplifiedMedialMesh result = simplify_medial_mesh(
      surface, chain, {.vertices = 2, .samples = 500, .check = 500, .search = 20'000, .rounds = 1});
  ASSERT_EQ(result.mesh.size(), 2u);
  ASSERT_EQ(result.mesh.edges.size(), 1u);
  EXPECT_LT(result.report.hausdorff.max, 0.01);  // the facets are off by as much
  for (Index v = 0; v < 2; ++v) {
    EXPECT_NEAR(result.mesh.radii[v], 1, 0.02);
    EXPECT_NEAR(std::abs(result.mesh.centers[v].z()), 1.5, 0.05);
    EXPECT_NEAR(result.mesh.centers[v].head<2>().norm(), 0, 0.01);
  }
}

SimplifiedMedialMesh in_twelve_balls(const std::array<double, 3>& sides, Index points) {
  const Surface surface(test::known_box(sides).solid);
  return simplify_medial_mesh(surface, built_axis(surface, points),
                              {.vertices = 12, .samples = 1500, .check = 2000, .search = 20'000, .rounds = 2});
}

// Its corners, with radius 0, and those of the rectangle in the middle.
TEST(SimplifiedMedialMesh, IsTheTwelveBallsOfABox) {
  const SimplifiedMedialMesh result = in_twelve_balls({1, 2, 3}, 300);
  EXPECT_EQ(result.mesh.size(), 12u);
  EXPECT_LT(result.report.hausdorff.max, 3e-4);
  EXPECT_LT(result.report.hausdorff.mean, 1e-5);
  EXPECT_EQ(std::count_if(result.mesh.radii.begin(), result.mesh.radii.end(), [](double r) { return r < 1e-4; }), 8);
  EXPECT_EQ(topology(result.mesh), (Topology{1, 0, 0}));
}

// An exact axis, that no sample is off at all: what quadrics leave off by rounding must not count as worse than that.
TEST(SimplifiedMedialMesh, IsTheTwelveBallsOfABoxFromManyVertices) {
  const SimplifiedMedialMesh result = in_twelve_balls({1, 1.3, 2}, 5000);
  EXPECT_EQ(result.mesh.size(), 12u);
  EXPECT_LT(result.report.hausdorff.max, 3e-4);
}

TEST(SimplifiedMedialMesh, OfOneVertexIsTheLargestInscribedBall) {
  const Surface box(test::known_box({1, 2, 3}).solid);
  const SimplifiedMedialMesh in_box = simplify_medial_mesh(
      box, built_axis(box, 300), {.vertices = 1, .samples = 1500, .check = 2000, .search = 20'000, .rounds = 2});
  ASSERT_EQ(in_box.mesh.size(), 1u);
  EXPECT_NEAR(in_box.mesh.radii[0], 0.5, 1e-6);
  // In the bend of an L with arms as wide as 1, a ball touches both outer sides and the reentrant edge.
  const Surface bend(test::known_l_shape(8).solid);
  const SimplifiedMedialMesh in_bend = simplify_medial_mesh(
      bend, built_axis(bend, 300), {.vertices = 1, .samples = 1500, .check = 2000, .search = 20'000, .rounds = 2});
  ASSERT_EQ(in_bend.mesh.size(), 1u);
  EXPECT_NEAR(in_bend.mesh.radii[0], std::sqrt(2.0) / (1 + std::sqrt(2.0)), 1e-5);
  EXPECT_NEAR(-bend.signed_distance(in_bend.mesh.centers[0]), in_bend.mesh.radii[0], 1e-12);
}

std::string message_for(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options) {
  try {
    simplify_medial_mesh(surface, mesh, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(SimplifiedMedialMesh, NamesTheLeastNumberThatTheTopologyAllows) {
  const Surface ring(test::torus(24, 12));
  const MedialMesh axis = built_axis(ring, 200, false);
  EXPECT_NE(message_for(ring, axis, {.vertices = 2, .samples = 500, .check = 500, .search = 20'000, .rounds = 1})
                .find("at least 3"),
            std::string::npos);
  const SimplifiedMedialMesh three =
      simplify_medial_mesh(ring, axis, {.vertices = 3, .samples = 500, .check = 500, .search = 20'000, .rounds = 1});
  EXPECT_EQ(three.mesh.size(), 3u);
  EXPECT_EQ(topology(three.mesh), (Topology{1, 1, 0}));
  const Surface boxes(test::two_boxes(0.5));
  EXPECT_NE(message_for(boxes, built_axis(boxes, 200, false),
                        {.vertices = 1, .samples = 500, .check = 500, .search = 20'000, .rounds = 1})
                .find("at least 2"),
            std::string::npos);
}

TEST(SimplifiedMedialMesh, SaysWhatIsProvedOfTheLeastNumberAndWhatIsNot) {
  const SimplifyOptions options{.vertices = 1, .samples = 500, .check = 500, .search = 20'000, .rounds = 1};
  const Surface ring(test::torus(24, 12));
  EXPECT_NE(message_for(ring, built_axis(ring, 200, false), options).find("topology of the axis allows; at least 3"),
            std::string::npos);
  // Components add.
  const Surface boxes(test::two_boxes(0.5));
  EXPECT_NE(message_for(boxes, built_axis(boxes, 200, false), options).find("topology of the axis allows; at least 2"),
            std::string::npos);
  // A triangulated projective plane has a loop and a cavity over the field with two elements: five vertices are proved
  // to be needed, and it needs six.
  MedialMesh plane;
  for (Index v = 0; v < 6; ++v) {
    plane.centers.push_back(Point(0.5 + 0.05 * v, 1 + 0.1 * (v % 3), 1.5 + 0.1 * (v % 2)));
    plane.radii.push_back(0.3);
  }
  plane.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 1, 5},
                     {1, 2, 4}, {2, 4, 5}, {2, 3, 5}, {1, 3, 5}, {1, 3, 4}};
  complete(plane);
  ASSERT_EQ(topology(plane), (Topology{1, 1, 1}));
  const std::string message = message_for(Surface(test::known_box({1, 2, 3}).solid), plane, options);
  EXPECT_NE(message.find("contractions led to 6"), std::string::npos) << message;
  EXPECT_NE(message.find("fewer than 5"), std::string::npos) << message;
}

TEST(SimplifiedMedialMesh, IsRefusedWhatItCannotDo) {
  const Surface box(test::known_box({1, 2, 3}).solid);
  const MedialMesh axis = built_axis(box, 60);
  EXPECT_NE(
      message_for(box, axis, {.samples = 1500, .check = 2000, .search = 20'000, .rounds = 2}).find("error above 0"),
      std::string::npos);
  EXPECT_NE(message_for(box, axis, {.error = 1e-12, .samples = 1500, .check = 2000, .search = 20'000, .rounds = 2})
                .find("come nearer"),
            std::string::npos);
  EXPECT_NE(message_for(Surface(test::open_box()), axis, {.vertices = 5}).find("solid"), std::string::npos);
}

// A box comes to its balls exactly: that they are off by less than the error is proved, not by how little.
TEST(SimplifiedMedialMesh, IsProvedToBeWithinTheErrorOnExactBalls) {
  const Surface box(test::known_box({1, 2, 3}).solid);
  const SimplifiedMedialMesh result =
      simplify_medial_mesh(box, built_axis(box, 200), {.error = 2e-3, .samples = 500, .check = 500, .rounds = 1});
  EXPECT_LE(result.report.upper, 2e-3);
  EXPECT_LE(result.mesh.size(), 20u);
}

TEST(SimplifiedMedialMesh, IsWithinTheErrorAskedFor) {
  const Surface surface(test::known_l_shape(8).solid);
  const MedialMesh axis = built_axis(surface, 200);
  const SimplifiedMedialMesh coarse =
      simplify_medial_mesh(surface, axis, {.error = 0.04, .samples = 500, .check = 500, .search = 20'000, .rounds = 1});
  const SimplifiedMedialMesh fine = simplify_medial_mesh(
      surface, axis, {.error = 0.006, .samples = 500, .check = 500, .search = 20'000, .rounds = 1});
  EXPECT_LE(coarse.report.upper, 0.04);
  EXPECT_LE(fine.report.upper, 0.006);
  EXPECT_LT(coarse.mesh.size(), fine.mesh.size());
  EXPECT_LT(fine.mesh.size(), axis.size() / 2);
}

TEST(SimplifiedMedialMesh, HasNoCenterOutsideAndTheRadiiOfTheAxis) {
  const Surface surface(test::known_l_shape(8).solid);
  const MedialMesh axis = built_axis(surface, 300);
  const SimplifyOptions options{.vertices = 16, .samples = 1000, .check = 1000, .search = 20'000, .rounds = 1};
  const SimplifiedMedialMesh result = simplify_medial_mesh(surface, axis, options);
  const double error = result.report.hausdorff.max * surface.bounding_box().diagonal().norm();
  for (Index v = 0; v < result.mesh.size(); ++v) {
    const double depth = -surface.signed_distance(result.mesh.centers[v]);
    EXPECT_GE(depth, 0) << v;
    EXPECT_NEAR(result.mesh.radii[v], depth, 1.01 * error) << v;
  }
}

TEST(SimplifiedMedialMesh, MedialBallsAreBroughtBackFromOutsideAndToTheirRadius) {
  const Surface box(test::known_box({1, 2, 3}).solid);
  const detail::Ball4 outside = detail::medial_ball(box, detail::ball4(Point(-0.25, 1, 1.5), 0.25), 0.1);
  EXPECT_LT((outside.head<3>() - Point(0, 1, 1.5)).norm(), 1e-6);
  EXPECT_TRUE(box.inside(outside.head<3>()));
  EXPECT_NEAR(outside[3], 0.1, 1e-6);
  const detail::Ball4 small = detail::medial_ball(box, detail::ball4(Point(0.5, 1, 1.5), 0.2), 0.1);
  EXPECT_EQ(small.head<3>(), Point(0.5, 1, 1.5));
  EXPECT_NEAR(small[3], 0.4, 1e-12);
  const detail::Ball4 right = detail::medial_ball(box, detail::ball4(Point(0.5, 1, 1.5), 0.45), 0.1);
  EXPECT_EQ(right[3], 0.45);
}

TEST(SimplifiedMedialMesh, IsNoFartherOffWithMoreBalls) {
  const Surface surface(test::known_l_shape(8).solid);
  const MedialMesh axis = built_axis(surface, 200);
  const SimplifyOptions options{.samples = 500, .check = 500, .search = 20'000, .rounds = 1};
  const std::vector<Index> counts{40, 30, 22, 16, 12};
  const auto results = simplify_to_each(surface, axis, counts, options);
  ASSERT_GE(results.size(), 3u);
  for (std::size_t i = 1; i < results.size(); ++i) EXPECT_LE(results[i - 1].report.upper, results[i].report.upper) << i;
}

// The distance from the surface of the farthest of random places of the envelope.
double max_attained(const Surface& surface, const MedialMesh& mesh, Random& random) {
  const detail::Reconstruction reconstruction(mesh);
  double attained = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto& corners = mesh.triangles[random.below(mesh.triangles.size())];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Point center =
        (1 - u - v) * mesh.centers[corners[0]] + u * mesh.centers[corners[1]] + v * mesh.centers[corners[2]];
    const double radius =
        (1 - u - v) * mesh.radii[corners[0]] + u * mesh.radii[corners[1]] + v * mesh.radii[corners[2]];
    const Vector way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Point place = center + radius * way.normalized();
    if (reconstruction.distance(place) > -1e-9) attained = std::max(attained, surface.distance(place));
  }
  return attained;
}

// Few balls leave dents between the samples that they fit.
TEST(SimplifiedMedialMesh, IsNowhereFartherOffThanIsProven) {
  const Surface box(test::known_box({1, 2, 3}).solid), bend(test::known_l_shape(8).solid);
  const std::vector<Index> counts{30, 16};
  for (std::uint64_t seed = test::first_seed(), end = seed + test::more(); seed < end; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 5);
    for (const Surface* solid : {&box, &bend}) {
      const double diagonal = solid->bounding_box().diagonal().norm();
      for (const auto& [mesh, report] :
           simplify_to_each(*solid, built_axis(*solid, 100), counts,
                            {.samples = 300, .check = 300, .search = 200'000, .rounds = 1, .seed = seed})) {
        EXPECT_LE(report.hausdorff.max, report.upper);
        EXPECT_LE(max_attained(*solid, mesh, random), report.upper * diagonal + 1e-9);
        if (solid == &box && report.hausdorff.max > 2e-3) {  // no crevices, and soon searched
          EXPECT_LE(report.upper, report.hausdorff.max + std::max(1e-4, 0.02 * report.hausdorff.max) + 1e-9);
        }
      }
    }
  }
}

TEST(SimplifiedMedialMesh, KeepsTheTopologyAllTheWayDown) {
  const Surface surface(test::torus(24, 12));
  const std::vector<Index> counts{60, 30, 10, 5, 3, 2};
  const auto curve = simplify_to_each(surface, built_axis(surface, 200, false), counts,
                                      {.samples = 500, .check = 500, .search = 20'000, .rounds = 1});
  ASSERT_EQ(curve.size(), 5u);  // no ring has two vertices
  for (std::size_t i = 0; i < curve.size(); ++i) {
    EXPECT_LE(curve[i].mesh.size(), counts[i]);
    EXPECT_EQ(topology(curve[i].mesh), (Topology{1, 1, 0}));
    EXPECT_NO_THROW(validate(curve[i].mesh));
  }
  EXPECT_LT(curve[0].report.hausdorff.mean, curve[4].report.hausdorff.mean);
}

TEST(SimplifiedMedialMesh, IsTheSameWhateverTheNumberOfThreads) {
  const Surface surface(test::known_l_shape(8).solid);
  const MedialMesh axis = built_axis(surface, 300);
  const SimplifyOptions options{.vertices = 40, .samples = 500, .check = 500, .search = 20'000, .rounds = 1};
  const std::string all = to_ma(simplify_medial_mesh(surface, axis, options).mesh);
  for (const std::size_t threads : {std::size_t{1}, std::size_t{7}}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(to_ma(simplify_medial_mesh(surface, axis, options).mesh), all) << threads << " threads";
  }
}

// The least |query - c| - r of a cell's balls, over a fine grid of them.
double brute_value(const std::vector<Ball4>& balls, const Point& query) {
  constexpr int kSteps = 200;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; i + k <= kSteps; ++k) {
      const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(k) / kSteps;
      const Ball4 ball = (1 - u - v) * balls[0] + u * balls[1] + v * balls[2];
      least = std::min(least, (query - ball.head<3>()).norm() - ball[3]);
    }
  }
  return least;
}

// Half of the sheet in the middle of a plate is gone: the envelope ends in a half cylinder whose crest is as deep in
// the plate as can be. Balls of the half that is left see nothing.
TEST(SimplifiedMedialMesh, HasItsDentsSeenFromTheBallsThatItHad) {
  const Surface plate(test::known_box({1, 4, 4}).solid);
  const auto at = [](double y, double z) { return Point(0.5, y, z); };
  MedialMesh half{.centers = {at(0.5, 0.5), at(1.5, 0.5), at(1.5, 3.5), at(0.5, 3.5)},
                  .radii = std::vector<double>(4, 0.5),
                  .edges = {},
                  .triangles = {{0, 1, 2}, {0, 2, 3}}};
  complete(half);
  const detail::Reconstruction reconstruction(half);
  std::vector<Sphere> left, lost;
  for (int k = 2; k <= 14; ++k) {
    for (int j = 2; j <= 6; ++j) left.push_back({at(0.25 * j, 0.25 * k), 0.5});
    for (int j = 7; j <= 14; ++j) lost.push_back({at(0.25 * j, 0.25 * k), 0.5});
  }
  EXPECT_TRUE(detail::dents_seen_from(left, plate, reconstruction, 0.1).empty());
  const auto dents = detail::dents_seen_from(lost, plate, reconstruction, 0.1);
  ASSERT_GT(dents.size(), 12U);
  EXPECT_NEAR(dents.front().depth, 0.5, 1e-12);
  for (const auto& [place, depth, outward] : dents) {
    EXPECT_NEAR(plate.signed_distance(place), -depth, 1e-12);
    EXPECT_NEAR(reconstruction.distance(place), 0, 1e-5);
    EXPECT_NEAR(plate.distance(place + depth * outward), 0, 1e-12);
  }
}

TEST(FootFinder, FindsTheBallThatBruteForceFinds) {
  Random random(3, 1);
  const auto number = [&] { return random.uniform(-1, 1); };
  for (int round = 0; round < 20; ++round) {
    MedialMesh mesh;
    for (int v = 0; v < 5; ++v) {
      mesh.centers.emplace_back(number(), number(), number());
      mesh.radii.push_back(random.uniform(0, 0.8));
    }
    mesh.triangles = {{0, 1, 2}};
    mesh.edges = {{2, 3}};
    complete(mesh);
    const ContractibleMesh contractible(mesh);
    const detail::FootFinder finder(contractible);
    const auto ball = [&](Index v) { return contractible.ball(v); };
    for (int k = 0; k < 5; ++k) {
      const Point query = 2 * Point(number(), number(), number());
      const double brute =
          std::min({brute_value({ball(0), ball(1), ball(2)}, query), brute_value({ball(2), ball(3), ball(3)}, query),
                    brute_value({ball(4), ball(4), ball(4)}, query)});
      const detail::Foot foot = finder.find(query);
      EXPECT_LE(foot.value, brute + 1e-12);
      EXPECT_NEAR(foot.value, brute, 2e-3);
      const Ball4 at = foot.ball(contractible);
      EXPECT_NEAR((query - at.head<3>()).norm() - at[3], foot.value, 1e-12);
    }
  }
}

MedialMesh moved(MedialMesh mesh, double by, Random& random) {
  for (Index v = 0; v < mesh.size(); ++v) {
    mesh.centers[v] += by * Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    mesh.radii[v] = std::max(0.0, mesh.radii[v] + by * random.uniform(-1, 1));
  }
  return mesh;
}

TEST(FootWalker, FollowsBallsThatMove) {
  Random random(11, 1);
  const Surface surface(test::known_l_shape(8).solid);
  const MedialMesh axis = built_axis(surface, 300);
  ContractibleMesh mesh(axis);
  detail::FootWalker walker(mesh);
  const MedialMesh other = moved(axis, 0.1, random);
  for (Index v = 0; v < other.size(); ++v) mesh.set_ball(v, detail::ball4(other.centers[v], other.radii[v]));
  walker.follow_mesh();
  const detail::FootWalker fresh(mesh);
  for (const detail::FitSample& sample : detail::fit_samples(surface, 300, 1)) {
    const detail::Foot start{.corners = {0, 0, 0}};
    const detail::Foot foot = walker.walk(sample.position, start);
    EXPECT_EQ(foot.value, fresh.walk(sample.position, start).value);
    EXPECT_NEAR(foot.value, detail::foot_on(mesh, foot.corners, sample.position).value, 1e-12);
  }
}

// Whether or not feet of the mesh are known, if only by the ball of any one vertex.
TEST(Assignment, FindsAllThatIsOff) {
  const Surface surface(test::known_l_shape(8).solid);
  const MedialMesh axis = built_axis(surface, 300);
  for (std::uint64_t k = 0; k < 20 * test::more(); ++k) {
    const std::uint64_t seed = test::first_seed() + k;
    Random random(seed, 12);
    const ContractibleMesh mesh(moved(axis, random.uniform(0.01, 0.3), random));
    const auto samples = detail::fit_samples(surface, 200, seed);
    detail::Assignment exact, from_neighbors, from_anywhere;
    exact.find(mesh, samples);
    const double enough = random.uniform(0.1, 0.9) * exact.max;
    from_neighbors.find_off(mesh, samples, enough);
    from_anywhere.feet.assign(samples.size(), {.corners = {1, 1, 1}});
    from_anywhere.find_off(mesh, samples, enough);
    for (const auto* found : {&from_neighbors, &from_anywhere}) {
      EXPECT_NEAR(found->max, exact.max, 1e-12);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double value = exact.feet[i].value, other = found->feet[i].value;
        EXPECT_GE(other, value - 1e-12);
        EXPECT_NEAR(other, value, std::abs(value) >= enough ? 1e-12 : 2 * enough);
        if (std::abs(value) < enough) {
          EXPECT_LT(std::abs(other), enough);
        }
      }
    }
  }
}

// However small the ball is, and whatever was known of places nearby.
TEST(Protrusion, IsThatOfTheBall) {
  const Surface surface(test::box({0, 0, 0}, {2, 2, 2}));
  for (std::uint64_t k = 0; k < 20 * test::more(); ++k) {
    Random random(test::first_seed() + k, 13);
    detail::InsideBall known;
    for (int look = 0; look < 50; ++look) {
      const Point center(random.uniform(-0.5, 2.5), random.uniform(-0.5, 2.5), random.uniform(-0.5, 2.5));
      const double radius = random.uniform(0, 1) < 0.2 ? 0 : random.uniform(0, 0.6);
      const double negligible = random.uniform(0, 1) < 0.5 ? 0 : random.uniform(0, 0.3);
      Vector outward;
      const double found = detail::protrusion_of(surface, detail::ball4(center, radius), negligible, known, outward);
      const double protrusion = radius + surface.signed_distance(center);
      if (protrusion > negligible + 1e-9) {
        EXPECT_NEAR(found, protrusion, 1e-9);
        EXPECT_NEAR(surface.signed_distance(center + radius * outward), protrusion, 1e-9);
      } else if (protrusion < negligible - 1e-9) {
        EXPECT_EQ(found, 0);
      }
    }
  }
}

}  // namespace
}  // namespace orchard
