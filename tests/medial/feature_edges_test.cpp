// Which edges of a mesh sheets end on: by what the axis would lose, not by an angle.
#include "features/feature_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/shapes.h"

namespace orchard {
namespace {

using detail::FeatureEdges;
using detail::FeatureOptions;
using detail::wedge_loss;

// Calls visit(triangle, side) for each edge once.
template <class Visit>
void visit_edges(const Surface& surface, const Visit& visit) {
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (t < surface.neighbors(t)[i]) visit(t, i);
    }
  }
}

FeatureOptions options_for(const Surface& surface) {
  const double diagonal = surface.bounding_box().diagonal().norm();
  return {.min_loss = 0.004 * diagonal, .min_length = 0.05 * diagonal};
}

TEST(WedgeLoss, OfACubesEdgeIsThatOfTheLargestBall) {
  const Surface surface(test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  int edges = 0;
  visit_edges(surface, [&](Index t, std::size_t i) {
    const double loss = wedge_loss(surface, t, i, 0.5);
    const bool is_edge = loss > 0;
    edges += is_edge ? 1 : 0;
    if (is_edge) {
      EXPECT_NEAR(loss, std::sqrt(2) - 1, 2e-3);
    }
  });
  EXPECT_EQ(edges, 12);  // the diagonals of its faces are none
}

TEST(WedgeLoss, BetweenTwoFacetsOfACylinderIsWhatTheAxisLosesThere) {
  const int around = 24;
  const Surface surface(test::turned({{1, -4}, {1, 4}}, around));
  const double loss = 1 - std::cos(std::numbers::pi / around);  // of the corner beyond the inscribed circle
  int facets = 0;
  visit_edges(surface, [&](Index t, std::size_t i) {
    const auto corners = surface.corners(t);
    const Vector along = (corners[(i + 1) % 3] - corners[i]).normalized();
    if (std::abs(along.z()) < 0.99999) return;  // the facets' diagonals are nearly upright
    ++facets;
    EXPECT_NEAR(wedge_loss(surface, t, i, 0.5), loss, 0.01 * loss);
  });
  EXPECT_EQ(facets, around);
}

TEST(WedgeLoss, OfAConcaveEdgeIsNothing) {
  const Surface surface(test::l_shape());
  int convex = 0, others = 0;
  visit_edges(surface, [&](Index t, std::size_t i) { ++(wedge_loss(surface, t, i, 0.5) > 0 ? convex : others); });
  EXPECT_EQ(convex, 17);  // of 18 edges one is concave
  EXPECT_GT(others, 0);
}

TEST(FeatureEdges, OfABoxAreItsTwelve) {
  const Surface surface(test::box(Point(0, 0, 0), Point(1, 2, 3)));
  EXPECT_EQ(FeatureEdges(surface, options_for(surface)).edges().size(), 12u);
}

TEST(FeatureEdges, OfACylinderAreItsRims) {
  for (const int around : {24, 64, 360}) {
    const Surface surface(test::turned({{1, -4}, {1, 4}}, around));
    EXPECT_EQ(FeatureEdges(surface, options_for(surface)).edges().size(), 2 * static_cast<std::size_t>(around))
        << around;
  }
}

TEST(FeatureEdges, OfAFewFacetsAreBetweenTheseToo) {
  const Surface surface(test::turned({{1, -4}, {1, 4}}, 6));
  EXPECT_EQ(FeatureEdges(surface, options_for(surface)).edges().size(), 18u);
}

TEST(FeatureEdges, AreNoneOfWhatIsRound) {
  for (const TriangleMesh& mesh : {test::icosphere(3), test::torus(48, 24)}) {
    const Surface surface(mesh);
    EXPECT_EQ(FeatureEdges(surface, options_for(surface)).edges().size(), 0u);
  }
}

// Both triangles at an edge say the same of it, and the size of the model does not matter.
TEST(FeatureEdges, AreThoseOfBothSidesAtAnyScale) {
  const Surface surface(test::l_shape());
  const Surface large(test::transformed(test::l_shape(), 1024, Vector::Zero()));
  const FeatureEdges features(surface, options_for(surface)), of_large(large, options_for(large));
  EXPECT_EQ(features.edges().size(), of_large.edges().size());
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(features.has(t, i), of_large.has(t, i));
      const Index other = surface.neighbors(t)[i];
      for (std::size_t k = 0; k < 3; ++k) {
        if (surface.neighbors(other)[k] == t) {
          EXPECT_EQ(features.has(t, i), features.has(other, k));
        }
      }
    }
  }
}

}  // namespace
}  // namespace orchard
