#include "orchard/medial/prune.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "axis/scale_axis.h"
#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
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
  const MedialAxis same = prune(axis, {});
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
      const MedialAxis pruned = prune(axis, options);
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
    const Index left = prune(axis, {.angle = angle * kDegree}).size();
    EXPECT_LE(left, last);
    last = left;
  }
  EXPECT_EQ(last, 1u);
}

// Sheets into right-angled edges are seen at 90 degrees, the middle sheet of a slab at 180.
TEST(Prune, ByAngleSeparatesTheSheetsOfABox) {
  const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
  const MedialAxis axis = axis_of(surface, 2000);
  const MedialAxis middle = prune(axis, {.angle = 150 * kDegree});
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
  EXPECT_GT(faces_at(prune(axis, {.angle = 60 * kDegree}), false), 0.8 * faces_at(axis, false));
}

TEST(Prune, ByScaleCutsTheSheetsIntoEdges) {
  const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
  const MedialAxis axis = axis_of(surface, 2000);
  const MedialAxis pruned = prune(axis, {.scale = 2.5});
  // A ball on a sheet into an edge, at depth t, has its centre sqrt(2) (0.5 - t) from the largest one there, which
  // holds it when both are enlarged by more than sqrt(2).
  EXPECT_LT(pruned.size(), axis.size() / 2);
  double min = 1;
  for (const double radius : pruned.radii) min = std::min(min, radius);
  EXPECT_GT(min, 0.3);
}

TEST(Prune, RefusesOptionsOutOfRange) {
  EXPECT_THROW(prune({}, {.angle = -1}), InputError);
  EXPECT_THROW(prune({}, {.angle = 4}), InputError);
  EXPECT_THROW(prune({}, {.scale = 0.5}), InputError);
}

TEST(CoveredWhenScaled, AgreesWithEveryPair) {
  std::vector<Point> centers;
  std::vector<double> radii;
  for (Index i = 0; i < 300; ++i) {
    Random random(9, i);
    centers.emplace_back(random.uniform(), random.uniform(), random.uniform());
    radii.push_back(random.uniform(0.01, 0.4));
  }
  for (const double scale : {1.0, 1.2, 2.0}) {
    const std::vector<std::uint8_t> covered = detail::covered_when_scaled(centers, radii, scale);
    int count = 0;
    for (std::size_t i = 0; i < centers.size(); ++i) {
      bool expected = false;
      for (std::size_t k = 0; scale > 1 && k < centers.size(); ++k) {
        expected = expected ||
                   (radii[k] > radii[i] && (centers[i] - centers[k]).norm() - scale * radii[k] < -scale * radii[i]);
      }
      EXPECT_EQ(covered[i] != 0, expected) << i;
      count += expected ? 1 : 0;
    }
    EXPECT_EQ(count > 0, scale > 1);
  }
}

}  // namespace
}  // namespace orchard
