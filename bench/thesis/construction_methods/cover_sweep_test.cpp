#include "cover_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "arrangement.h"
#include "monotone_curve.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"

namespace orchard::construction_methods {
namespace {

using Region = std::vector<PlanePoint>;
const Region kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Region kStar{{0.5, 0},    {0.6, 0.35}, {1, 0.4},   {0.7, 0.6}, {0.8, 1},
                   {0.5, 0.75}, {0.2, 1},    {0.3, 0.6}, {0, 0.4},   {0.4, 0.35}};

PlanarShape rectangle(double x0, double y0, double x1, double y1) { return PlanarShape::rectangle({x0, y0}, {x1, y1}); }

bool holds(const PlanarShape& shape, const PlanePoint& p) {
  if (shape.corners.empty()) return (p - shape.center).norm() <= shape.radius;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    const PlanePoint along = shape.corners[(i + 1) % shape.corners.size()] - shape.corners[i],
                     out = p - shape.corners[i];
    const double area = along.x() * out.y() - along.y() * out.x();
    left += area >= 0, right += area <= 0;
  }
  return std::max(left, right) == static_cast<int>(shape.corners.size());
}

TEST(CoverSweep, AnswersAsTheGeneralAlgorithmOnRandomArrangements) {
  int covered = 0;
  constexpr int kArrangements = 12'000;
  for (std::uint64_t seed = 0; seed < kArrangements; ++seed) {
    const auto shapes = random_arrangement(seed);
    const Region& region = seed % 3 == 0 ? kStar : kSquare;
    const bool general = cover_of_polygon(region, shapes).covered;
    ASSERT_EQ(cover_by_sweep(region, shapes).covered, general) << "seed " << seed;
    covered += general;
  }
  EXPECT_GT(covered, kArrangements / 10);
  EXPECT_LT(covered, kArrangements * 9 / 10);
}

TEST(CoverSweep, AnswersAsTheGeneralAlgorithmOfManyDisks) {
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto disks = many_disks(300, seed);
    const bool general = cover_of_polygon(kSquare, disks).covered;
    EXPECT_EQ(cover_by_sweep(kSquare, disks).covered, general) << "seed " << seed;
    covered += general;
  }
  EXPECT_GT(covered, 3);
  EXPECT_LT(covered, 37);
}

TEST(CoverSweep, NamesAPointOfTheRegionThatNoShapeHolds) {
  int gaps = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto shapes = random_arrangement(seed);
    const SweptCover cover = cover_by_sweep(kSquare, shapes);
    if (cover.covered) continue;
    ++gaps;
    EXPECT_TRUE(holds(PlanarShape::polygon(kSquare), cover.witness)) << "seed " << seed;
    EXPECT_TRUE(std::none_of(shapes.begin(), shapes.end(), [&](const auto& s) { return holds(s, cover.witness); }))
        << "seed " << seed;
  }
  EXPECT_GT(gaps, 500);
}

TEST(CoverSweep, KnowsTilesHolesAndRegionsThatAreNotConvex) {
  const auto covered = [](const Region& region, const std::vector<PlanarShape>& shapes) {
    return cover_by_sweep(region, shapes).covered;
  };
  EXPECT_TRUE(covered(kSquare, {rectangle(0, 0, 1, 1)}));
  EXPECT_TRUE(covered(kSquare, {rectangle(0, 0, 0.25, 1), rectangle(0.25, 0, 1, 0.5), rectangle(0.25, 0.5, 1, 1)}));
  EXPECT_FALSE(covered(kSquare, {rectangle(0, 0, 0.25, 1), rectangle(0.25, 0, 1, 0.5), rectangle(0.25, 0.501, 1, 1)}));
  EXPECT_FALSE(covered(kSquare, {}));
  const std::vector<PlanarShape> frame{rectangle(-1, -1, 2, 0.4), rectangle(-1, 0.6, 2, 2), rectangle(-1, 0, 0.4, 1),
                                       rectangle(0.6, 0, 2, 1)};
  EXPECT_FALSE(covered(kSquare, frame));
  auto filled = frame;
  filled.push_back(PlanarShape::disk({0.5, 0.5}, 0.15));
  EXPECT_TRUE(covered(kSquare, filled));
  const Region l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_TRUE(covered(l, {rectangle(0, 0, 2, 1), rectangle(0, 1, 1, 2)}));
  EXPECT_FALSE(covered(l, {rectangle(0, 0, 2, 1)}));
  EXPECT_TRUE(covered(l, {PlanarShape::disk({1, 1}, 1.5)}));
}

TEST(CoverSweep, RefusesWhatIsNoShape) {
  EXPECT_THROW(cover_by_sweep(kSquare, std::vector{PlanarShape::disk({0, 0}, -1)}), InputError);
  EXPECT_THROW(cover_by_sweep(kSquare, std::vector{PlanarShape::polygon({{0, 0}, {1, 1}, {2, 2}})}), InputError);
}

TEST(MonotoneCurve, IsOvertakenOnceForEachOrder) {
  MonotoneCurve line{.low = -2, .high = 2}, half{.low = -1, .high = 1, .side = 1, .radius = 1};
  line.center = {0.5, 0};
  const auto first = overtaking(line, half), second = overtaking(half, line);
  ASSERT_TRUE(first && second);  // the line is left of the half circle between its two crossings
  EXPECT_NEAR(*second, -std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(*first, std::sqrt(0.75), 1e-12);
  half.side = -1;
  EXPECT_FALSE(overtaking(line, half));
}

}  // namespace
}  // namespace orchard::construction_methods
