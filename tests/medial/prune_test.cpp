#include "orchard/medial/prune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/build.h"
#include "orchard/medial/importance.h"
#include "orchard/medial/topology.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

MedialAxis axis_of(const Surface& surface, Index points = 1000) {
  return build_medial_axis(surface, {.sampling = {.face_points = points - points / 5, .edge_points = points / 5}}).axis;
}

TEST(Prune, WithTheDefaultsChangesNothing) {
  const Surface surface(test::l_shape());
  const MedialAxis axis = axis_of(surface);
  const MedialAxis same = prune(surface, axis, {});
  EXPECT_EQ(same.centers, axis.centers);
  EXPECT_EQ(same.neighbors.items, axis.neighbors.items);
  EXPECT_EQ(same.faces.items, axis.faces.items);
}

TEST(Prune, KeepsTheTopologyWhateverTheOptions) {
  for (const TriangleMesh& mesh : {test::torus(32, 16), test::l_shape(), test::two_boxes(0.3), test::icosphere(3)}) {
    const Surface surface(mesh);
    const MedialAxis axis = axis_of(surface);
    const Topology wanted = solid_topology(surface);
    for (const PruneOptions& options : {PruneOptions{.angle = 20 * kDegree}, PruneOptions{.angle = 100 * kDegree},
                                        PruneOptions{.angle = std::numbers::pi}, PruneOptions{.scale = 1.1},
                                        PruneOptions{.scale = 5}, PruneOptions{.angle = 60 * kDegree, .scale = 1.3}}) {
      const MedialAxis pruned = prune(surface, axis, options);
      validate(pruned, surface);
      const MedialMesh result = medial_mesh(pruned);
      validate(result);
      EXPECT_EQ(topology(result), wanted) << options.angle << ' ' << options.scale;
      EXPECT_LE(pruned.size(), axis.size());
    }
  }
}

TEST(Prune, CutsMoreOffForLargerAnglesAndScales) {
  const Surface surface(test::icosphere(3));  // facets are noise to its one ball
  const MedialAxis axis = axis_of(surface);
  Index last = axis.size() + 1;
  for (const double angle : {0.0, 30.0, 90.0, 180.0}) {
    const Index left = prune(surface, axis, {.angle = angle * kDegree}).size();
    EXPECT_LE(left, last);
    last = left;
  }
  EXPECT_EQ(last, 1u);
}

// Sheets into right-angled edges are seen at 90 degrees, the middle sheet of a slab at 180.
TEST(Prune, ByAngleSeparatesTheSheetsOfABox) {
  const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
  const MedialAxis axis = axis_of(surface, 2000);
  const MedialAxis middle = prune(surface, axis, {.angle = 150 * kDegree});
  const auto faces_at = [](const MedialAxis& some, bool in_the_middle) {
    Index count = 0;
    for (Index face = 0; face < some.faces.size(); ++face) {
      Point center = Point::Zero();
      for (const Index corner : some.faces[face]) center += some.centers[corner] / some.faces[face].size();
      count += (std::abs(center.x() - 0.5) < 0.1) == in_the_middle ? 1 : 0;
    }
    return count;
  };
  // What stays of the others lies nearer to the edges than the points do to each other, where angles mean nothing.
  EXPECT_GT(faces_at(middle, true), 0.6 * faces_at(axis, true));
  EXPECT_LT(faces_at(middle, false), 0.5 * faces_at(axis, false));
  EXPECT_GT(faces_at(prune(surface, axis, {.angle = 60 * kDegree}), false), 0.8 * faces_at(axis, false));
}

TEST(Prune, ByScaleCutsTheSheetsIntoEdges) {
  const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
  const MedialAxis axis = axis_of(surface, 2000);
  const MedialAxis pruned = prune(surface, axis, {.scale = 2.5});
  // A ball on a sheet into an edge, at depth t, has its centre sqrt(2) (0.5 - t) from the largest one there, which
  // holds it when both are enlarged by more than sqrt(2).
  EXPECT_LT(pruned.size(), axis.size() / 2);
  double min = 1;
  for (const double radius : pruned.radii) min = std::min(min, radius);
  EXPECT_GT(min, 0.3);
}

TEST(Prune, RefusesOptionsOutOfRange) {
  const Surface ball(test::icosphere(1));
  EXPECT_THROW(prune(ball, {}, {.angle = -1}), InputError);
  EXPECT_THROW(prune(ball, {}, {.angle = 4}), InputError);
  EXPECT_THROW(prune(ball, {}, {.scale = 0.5}), InputError);
  EXPECT_THROW(prune(ball, {}, {.lambda = -0.1}), InputError);
  EXPECT_THROW(prune(ball, {}, {.erosion = std::nan("")}), InputError);
}

MedialAxis refined_axis_of(const Surface& surface) {
  MedialBuildOptions options{.sampling = {.face_points = 400, .edge_points = 100}, .check_promise = false};
  options.refine.emplace();
  return build_medial_axis(surface, options).axis;
}

TEST(Prune, OfARefinedAxisKeepsTheTopologyByEveryMeasure) {
  for (const TriangleMesh& mesh : {test::torus(24, 12), test::l_shape()}) {
    const Surface surface(mesh);
    const MedialAxis axis = refined_axis_of(surface);
    const Topology wanted = solid_topology(surface);
    for (const PruneOptions& options :
         {PruneOptions{.angle = 100 * kDegree}, PruneOptions{.scale = 1.3}, PruneOptions{.border_loss = 0.05},
          PruneOptions{.lambda = 0.1}, PruneOptions{.erosion = 0.05}, PruneOptions{.geodesic = 0.5},
          PruneOptions{.angle = 60 * kDegree, .lambda = 0.03, .erosion = 0.02}}) {
      const MedialMesh result = medial_mesh(prune(surface, axis, options));
      validate(result);
      EXPECT_EQ(topology(result), wanted);
    }
  }
}

// The middle sheet of a plate is at least its thickness from the rims, and sheets into edges are at most sqrt(2) / 2
// wide.
TEST(Prune, OfARefinedAxisCutsTrianglesAlongTheLevel) {
  const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
  const MedialAxis axis = refined_axis_of(surface);
  const double diagonal = surface.bounding_box().diagonal().norm();
  for (const double level : {0.25, 0.5}) {
    const MedialAxis pruned = prune(surface, axis, {.border_loss = level * 0.2 / diagonal});
    const std::vector<double> losses = importance(surface, pruned, ImportanceMeasure::border_loss);
    double least = 1;
    for (const double loss : losses) least = std::min(least, loss);
    EXPECT_NEAR(least, level * 0.2, 0.02 * level);
    const double angle_radius = least / (std::sqrt(2.0) - 1);  // of balls at a right-angled edge that lose this
    EXPECT_NEAR(*std::min_element(pruned.radii.begin(), pruned.radii.end()), angle_radius, 0.05 * angle_radius);
  }
}

TEST(Prune, WithKnownValuesIsTheSameAsWithoutThem) {
  const Surface surface(test::l_shape());
  const double diagonal = surface.bounding_box().diagonal().norm();
  for (const MedialAxis& axis : {axis_of(surface, 500), refined_axis_of(surface)}) {
    for (const ImportanceMeasure measure : kImportanceMeasures) {
      PruneOptions options;
      const double limit = measure == ImportanceMeasure::angle      ? 1.7
                           : measure == ImportanceMeasure::scale    ? 1.5
                           : measure == ImportanceMeasure::geodesic ? 0.4
                                                                    : 0.04;
      limit_of(options, measure) = limit;
      const MedialAxis expected = prune(surface, axis, options),
                       found = prune(surface, axis, measure, importance(surface, axis, measure),
                                     is_length(measure) ? limit * diagonal : limit);
      EXPECT_NE(found.centers, axis.centers) << name_of(measure);
      EXPECT_EQ(found.centers, expected.centers) << name_of(measure);
      EXPECT_EQ(found.faces.items, expected.faces.items) << name_of(measure);
    }
  }
}

TEST(Prune, IsTheLastStepOfABuild) {
  const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
  MedialBuildOptions options{.sampling = {.face_points = 800, .edge_points = 200}};
  options.refine.emplace();
  options.prune.angle = 100 * kDegree;
  const MedialBuild build = build_medial_axis(surface, options);
  EXPECT_LT(build.axis.size(), build.unpruned_vertices);
  EXPECT_GT(*std::min_element(build.axis.radii.begin(), build.axis.radii.end()), 0.25)
      << "only the middle sheet is left, up to the triangle across its seam";
  EXPECT_TRUE(build.features.empty()) << "no sheet reaches an edge any more";
  EXPECT_TRUE(build.promise.keeps_topology());
}

}  // namespace
}  // namespace orchard
