#include "simplify/shape_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace orchard::detail {
namespace {

// Two triangles side by side make a square of a unit's length: corners 0, 1, 2, 3, and a diagonal from 0 to 2.
MedialMesh square() {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.radii = {1, 1, 1, 1};
  mesh.edges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// A strip of three squares: corners 0 to 3 below, 4 to 7 above.
MedialMesh strip() {
  MedialMesh mesh;
  for (const double y : {0.0, 1.0}) {
    for (int x = 0; x < 4; ++x) mesh.centers.emplace_back(x, y, 0);
  }
  mesh.radii.assign(8, 1);
  for (Index x = 0; x < 3; ++x) {
    mesh.triangles.push_back({x, x + 1, x + 5});
    mesh.triangles.push_back({x, x + 4, x + 5});
    mesh.edges.insert(mesh.edges.end(), {{x, x + 1}, {x, x + 4}, {x, x + 5}, {x + 4, x + 5}});
  }
  mesh.edges.push_back({3, 7});
  std::sort(mesh.edges.begin(), mesh.edges.end());
  return mesh;
}

TEST(ShapeCost, IsWhatTrianglesGainOrLoseInQuality) {
  const ContractibleMesh mesh(square());
  // Half a unit square: legs 1, hypotenuse sqrt(2).
  const double quality = 6 / std::sqrt(3.0) * 0.5 / ((2 + std::sqrt(2.0)) / 2 * std::sqrt(2.0));
  // Corner 1 goes to corner 0: one of two triangles vanishes, and the other stays as it is.
  EXPECT_NEAR(ShapeCost(mesh).added(0, 1, ball4({0, 0, 0}, 1)), -(1 - quality) / 2, 1e-12);
  // To a place on the line through 2 and 3: the other has no area then.
  EXPECT_NEAR(ShapeCost(mesh).added(0, 1, ball4({-1, 1, 0}, 1)), -(1 - quality) + 0.5, 1e-12);
}

TEST(ShapeCost, DoesNotDependOnWhichEndIsNamedFirst) {
  const ContractibleMesh mesh(strip());
  for (const auto& [a, b] : {std::array<Index, 2>{0, 1}, {1, 6}, {1, 5}})
    EXPECT_NEAR(ShapeCost(mesh).added(a, b, ball4({1, 0.5, 0}, 1)), ShapeCost(mesh).added(b, a, ball4({1, 0.5, 0}, 1)),
                1e-12);
}

TEST(ShapeCost, PinchingASheetBetweenTwoBordersCostsMoreThanAnyOfItsTriangles) {
  const ContractibleMesh mesh(strip());
  const ShapeCost cost(mesh);
  // The rung from 1 to 5 leads through the sheet from border to border; the edge from 1 to 2 lies on one border.
  const double pinch = cost.added(1, 5, ball4({1, 0.5, 0}, 1)), along = cost.added(1, 2, ball4({1.5, 0, 0}, 1));
  EXPECT_GT(pinch, along + 1.0 / 6);
}

}  // namespace
}  // namespace orchard::detail
