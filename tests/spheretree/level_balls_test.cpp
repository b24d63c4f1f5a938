#include "tightened/level_balls.h"  // private

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/random.h"
#include "support/effort.h"

namespace orchard {
namespace {

using detail::BallPlaces;
using detail::LevelBall;
using detail::LevelBalls;
using detail::PathRegions;
using detail::Samples;

Samples on_axis(std::initializer_list<double> xs) {
  Samples samples;
  for (const double x : xs) samples.points.emplace_back(x, 0, 0);
  samples.starts = samples.points;
  return samples;
}

Sphere ball(double x, double radius) { return {Point(x, 0, 0), radius}; }

LevelBall placed(double x, double radius, Index path_region) {
  LevelBall placed;
  placed.center = Point(x, 0, 0);
  placed.radius = radius;
  placed.path_region = path_region;
  return placed;
}

// Samples 0..4 at 1, 4, 5, 6, 9; path region 0 reaches to 6.5 from below, path region 1 to 3.5 from above.
PathRegions two_regions() {
  return {on_axis({1, 4, 5, 6, 9}), {{ball(5, 20), ball(2.5, 4)}, {ball(5, 20), ball(7.5, 4)}}};
}

// Balls 0 and 1 lie in path region 0 and hold 0, 1 and 1, 2, 3; ball 2 lies in path region 1 and holds 3, 4.
LevelBalls three_balls(Index max_children = 2) {
  return {two_regions(), {placed(2.5, 1.6, 0), placed(5, 1.1, 0), placed(7.5, 1.6, 1)}, max_children};
}

TEST(PathRegions, HoldTheSamplesInAllBallsOfTheirPath) {
  const PathRegions regions(on_axis({1, 30, 5, 9}), {{ball(5, 20), ball(2.5, 4)}, {ball(5, 20), ball(7.5, 4)}});
  ASSERT_EQ(regions.samples().size(), 3u);  // the one at 30 is in neither
  EXPECT_EQ(regions.samples_in(0), (std::vector<Index>{0, 1}));
  EXPECT_EQ(regions.samples_in(1), (std::vector<Index>{1, 2}));
  EXPECT_EQ(regions.regions_of(1), (std::vector<Index>{0, 1}));
  EXPECT_TRUE(regions.holds(1, Point(11, 0, 0)));
  EXPECT_FALSE(regions.holds(0, Point(11, 0, 0)));
  EXPECT_FALSE(regions.holds_sample(0, 2));
}

TEST(PathRegions, NameTheSamplesNearACenter) {
  for (std::uint64_t k = 0; k < 20 * test::more(); ++k) {
    Random random(test::first_seed() + k, 61);
    const auto anywhere = [&] { return Point(random.uniform(), random.uniform(), random.uniform()); };
    Samples samples;
    const auto count = static_cast<Index>(random.below(1000));
    for (Index s = 0; s < count; ++s) samples.points.push_back(anywhere());
    samples.starts = samples.points;
    const std::vector<Sphere> everywhere{{Point(0.5, 0.5, 0.5), 1}}, half{everywhere[0], {Point(0, 0, 0), 0.9}};
    const PathRegions regions(samples, {everywhere, half});
    for (const Index region : {0u, 1u}) {
      const Point center = anywhere();
      const double squared = random.uniform();
      const auto first = static_cast<Index>(random.below(count + 1));
      std::vector<Index> found{9}, wanted{9};
      regions.append_samples(region, first, center, squared, found);
      for (Index s : regions.samples_in(region))
        if (s >= first && (samples.points[s] - center).squaredNorm() <= squared) wanted.push_back(s);
      EXPECT_EQ(found, wanted) << "seed " << k;
    }
  }
}

// Against every path region, for balls of very different sizes and points that are in none.
TEST(PathRegions, AroundAPointAreAllThatHoldIt) {
  const std::uint64_t first = test::first_seed();
  for (std::uint64_t seed = first; seed < first + 10 * test::more(); ++seed) {
    Random random(seed, 1);
    const auto place = [&](double reach) {
      return Point(random.uniform(-reach, reach), random.uniform(-reach, reach), 0.1 * random.uniform(-reach, reach));
    };
    std::vector<std::vector<Sphere>> paths;
    const std::size_t count = 1 + random.below(200);
    for (std::size_t r = 0; r < count; ++r)
      paths.push_back({{place(3), 8}, {place(10), std::exp(random.uniform(-4, 2))}});
    const PathRegions regions({}, paths);
    for (int i = 0; i < 200; ++i) {
      const Sphere& some = paths[random.below(count)].back();
      const Point point = i % 2 == 0 ? place(20) : Point(some.center + some.radius * Vector::UnitX());
      std::vector<Index> holding;
      for (Index r = 0; r < count; ++r)
        if (regions.holds(r, point)) holding.push_back(r);
      ASSERT_EQ(regions.regions_around(point), holding) << "seed " << seed;
    }
  }
}

TEST(LevelBalls, HoldSamplesOfTheirOwnPathRegionOnly) {
  const LevelBalls balls(two_regions(), {placed(6, 3, 0), placed(6, 3, 1)}, 2);
  EXPECT_EQ(balls[0].samples, (std::vector<Index>{1, 2, 3}));
  EXPECT_EQ(balls[1].samples, (std::vector<Index>{1, 2, 3, 4}));
}

TEST(LevelBalls, KnowWhatOnlySomeOfThemHold) {
  const LevelBalls balls = three_balls();
  const std::vector<Index> first{0}, both{0, 1};
  EXPECT_EQ(balls.held_only_by(first), (std::vector<Index>{0}));
  EXPECT_EQ(balls.held_only_by(both), (std::vector<Index>{0, 1, 2}));
  std::vector<Point> alone;
  balls.append_held_alone(1, alone);
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_EQ(alone[0], Point(5, 0, 0));
}

TEST(LevelBalls, CountAgainWhenOneIsReplaced) {
  LevelBalls balls = three_balls();
  balls.replace(1, balls.fitted(1, {Point(5, 0, 0), 0.5, 0}));  // lets 1 and 3 go
  const std::vector<Index> first{0}, last{2};
  EXPECT_EQ(balls.held_only_by(first), (std::vector<Index>{0, 1}));
  EXPECT_EQ(balls.held_only_by(last), (std::vector<Index>{3, 4}));
}

TEST(LevelBalls, RefuseAReplacementThatLosesASample) {
  LevelBalls balls = three_balls();
  const std::vector<Index> chosen{0};
  std::vector<LevelBall> by{placed(4, 0.5, 0)};
  balls.find_samples(by[0]);
  EXPECT_FALSE(balls.try_replace(chosen, by));
  EXPECT_EQ(balls[0].samples, (std::vector<Index>{0, 1}));
  EXPECT_EQ(by[0].samples, (std::vector<Index>{1}));
  EXPECT_EQ(balls.held_only_by(chosen), (std::vector<Index>{0}));

  by = {placed(1, 0.5, 0)};  // lets go only what ball 1 holds too
  balls.find_samples(by[0]);
  EXPECT_TRUE(balls.try_replace(chosen, by));
  EXPECT_EQ(balls[0].samples, (std::vector<Index>{0}));
  EXPECT_EQ(by[0].samples, (std::vector<Index>{0, 1}));
}

TEST(LevelBalls, RefuseMoreBallsInAPathRegionThanAllowed) {
  for (const Index max : {2u, 3u}) {
    LevelBalls balls = three_balls(max);
    const std::vector<Index> chosen{2};
    std::vector<LevelBall> by{placed(7.5, 1.6, 0)};
    by[0].samples = {3, 4};  // as if path region 0 held them
    EXPECT_EQ(balls.try_replace(chosen, by), max == 3);
    EXPECT_EQ(balls[2].path_region, max == 3 ? 0u : 1u);
  }
}

TEST(LevelBalls, TakeTheNewSamplesThatTheyHold) {
  LevelBalls balls = three_balls();
  balls.add_samples(on_axis({3, 40, 6.2}));
  EXPECT_EQ(balls[0].samples, (std::vector<Index>{0, 1, 5}));
  EXPECT_EQ(balls[2].samples, (std::vector<Index>{3, 4, 7}));
  EXPECT_TRUE(balls.regions().regions_of(6).empty());
  const std::vector<Index> first{0}, last{2};
  EXPECT_EQ(balls.held_only_by(first), (std::vector<Index>{0, 5}));
  EXPECT_EQ(balls.held_only_by(last), (std::vector<Index>{4, 7}));
}

// Against a look at all of them, with fresh multipliers each time.
TEST(BallPlaces, NameAllBallsThatMayBeAmongTheNearest) {
  for (std::uint64_t k = 0; k < 300 * test::more(); ++k) {
    const std::uint64_t seed = test::first_seed() + k;
    Random random(seed, 7);
    const Index count = 2 + static_cast<Index>(random.below(seed % 3 == 0 ? 600 : 40));
    std::vector<LevelBall> balls(count);
    BallPlaces places;
    places.resize(count);
    for (Index b = 0; b < count; ++b) {
      balls[b].center = Point(random.uniform(), random.uniform(), random.uniform());
      if (seed % 5 == 0) balls[b].center = (4 * balls[b].center).array().floor();  // many distances are equal
      balls[b].radius = random.uniform(0, seed % 2 == 0 ? 0.1 : 2);
      places.set(b, balls[b]);
    }
    const Index of = static_cast<Index>(random.below(balls.size() | 1)) % count;
    const std::size_t wanted = 1 + random.below(8);
    const std::vector<Index> named = places.nearest(of, wanted, 0.8, 1.25);
    EXPECT_TRUE(std::is_sorted(named.begin(), named.end()));
    EXPECT_TRUE(std::find(named.begin(), named.end(), of) == named.end());
    EXPECT_GE(named.size(), std::min<std::size_t>(wanted, count - 1));
    for (int draw = 0; draw < 4; ++draw) {
      std::vector<std::pair<double, Index>> near;
      for (Index b = 0; b < count; ++b) {
        const double apart = (balls[b].center - balls[of].center).norm() - 0.5 * balls[b].radius;
        const double factor = draw == 0 ? (random.below(2) == 0 ? 0.8 : 1.25) : random.uniform(0.8, 1.25);
        if (b != of) near.emplace_back(apart * factor, b);
      }
      std::sort(near.begin(), near.end());
      for (std::size_t i = 0; i < std::min(wanted, near.size()); ++i)
        EXPECT_TRUE(std::binary_search(named.begin(), named.end(), near[i].second)) << "seed " << seed;
    }
  }
}

// Few balls are named where many are far away: the search asks this before every trial.
TEST(BallPlaces, NameFewBallsOfMany) {
  constexpr Index kCount = 4000;
  BallPlaces places;
  places.resize(kCount);
  Random random(1, 8);
  for (Index b = 0; b < kCount; ++b) {
    LevelBall ball;
    ball.center = Point(random.uniform(), random.uniform(), random.uniform());
    ball.radius = 0.05;
    places.set(b, ball);
  }
  std::size_t named = 0;
  for (Index b = 0; b < 100; ++b) named += places.nearest(b, 3, 0.8, 1.25).size();
  EXPECT_LT(named, 100u * 40u);
}

}  // namespace
}  // namespace orchard
