// One world under all that can be done to it, made by the same few helpers: hence more than 300 lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "any_broad_phase.h"
#include "runtime/every_machine.h"
#include "runtime/numbers.h"
#include "worlds.h"

namespace orchard::runtime {
namespace {

using test::kStep;

using test::MovingBodies;
using test::WorldShape;

WorldShape random_shape(test::Draw& draw, std::size_t bodies) {
  WorldShape shape{.bodies = bodies};
  shape.ball = std::cbrt(static_cast<double>(bodies)) * draw.uniform(1.2, 12);
  shape.min_radius = draw.uniform(0, 1) < 0.1 ? 0 : draw.uniform(0, 0.5);
  shape.max_acceleration = draw.uniform(0, 1) < 0.2 ? 0 : draw.uniform(0, 40);
  shape.period = draw.uniform(0.1, 0.6);
  shape.half_spaces = draw.uniform(0, 1) < 0.5 ? 0 : draw.uniform(0, 1);
  shape.extreme = draw.uniform(0, 1) < 0.5;
  shape.staggered = draw.uniform(0, 1) < 0.3;
  return shape;
}

using Reports = std::map<int, std::vector<BodyPair>>;  // by step

Reports run(const MovingBodies& bodies, const test::AnyOptions& any, double end, double frame) {
  const BroadPhaseOptions& options = any.common;
  BroadPhase world = test::make_broad_phase(bodies.source(), any);
  for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
  Reports reports;
  for (int frames = 0; frames * frame < end + frame; ++frames) {
    const double t = std::min(frames * frame, end);
    for (Advance now = world.advance(t); !now.pairs.empty(); now = world.advance(t)) {
      EXPECT_LE(now.time, t + 1e-9);
      EXPECT_TRUE(std::is_sorted(now.pairs.begin(), now.pairs.end()));
      auto& report = reports[static_cast<int>(std::lround((now.time - options.start) / options.time_step))];
      EXPECT_TRUE(report.empty()) << "a step twice";
      report.assign(now.pairs.begin(), now.pairs.end());
    }
  }
  return reports;
}

Reports brute_force(const MovingBodies& bodies, const BroadPhaseOptions& options, double end) {
  Reports reports;
  for (int step = 0; options.start + step * options.time_step <= end + 1e-9; ++step) {
    if (auto pairs = bodies.touching(options.start + step * options.time_step); !pairs.empty()) reports[step] = pairs;
  }
  return reports;
}

class EveryMethod : public testing::TestWithParam<test::AnyMethod> {};
INSTANTIATE_TEST_SUITE_P(BroadPhase, EveryMethod, testing::ValuesIn(test::kMethods));

TEST_P(EveryMethod, ReportsWhatOverlapsAtEachStep) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    test::Draw draw(seed);
    const std::size_t n = seed == 500 ? 300 : seed % 100 == 99 ? 80 : 2 + seed % 24;
    const MovingBodies bodies(random_shape(draw, n), seed);
    test::AnyOptions options{.method = GetParam(), .common = {.time_step = draw.uniform(0.008, 0.03)}};
    if (seed % 3 == 1) options.rebuild = test::Rebuild::everything;
    ASSERT_EQ(run(bodies, options, 1, draw.uniform(0.005, 0.1)), brute_force(bodies, options.common, 1))
        << "seed " << seed;
  }
}

TEST(BroadPhase, ReportsWhatOverlapsAtEachStepInThousandsOfWorlds) {
  for (std::uint64_t seed = 1000; seed < 4000; ++seed) {
    test::Draw draw(seed);
    const std::size_t n = seed % 500 == 0 ? 300 : seed % 50 == 0 ? 100 : 2 + seed % 28;
    WorldShape shape = random_shape(draw, n);
    if (seed % 3 == 0) shape.wind = std::pow(10, draw.uniform(0, 5)) * draw.direction();
    const MovingBodies bodies(shape, seed);
    BroadPhaseOptions options{.time_step = draw.uniform(0.008, 0.03)};
    if (seed % 4 == 0) options.window = static_cast<std::uint32_t>(1 + seed % 40);
    const auto machine = test::on_portable_machine(seed % 5 == 0);
    ASSERT_EQ(run(bodies, {.common = options}, 1, draw.uniform(0.005, 0.1)), brute_force(bodies, options, 1))
        << "seed " << seed;
  }
}

// The promise in the header, checked ten times as finely.
TEST(BroadPhase, ReportsEveryOverlapThatLastsForATimeStep) {
  int overlaps = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    test::Draw draw(seed + 77);
    const MovingBodies bodies(random_shape(draw, 2 + seed % 20), seed + 77);
    const BroadPhaseOptions options{.time_step = 0.02};
    const Reports reports = run(bodies, {.common = options}, 1, 0.02);
    std::map<BodyPair, int> since;  // the first fine sample of the overlap under way
    for (int fine = 0; fine <= 500; ++fine) {
      const auto pairs = bodies.touching(0.002 * fine);
      std::erase_if(since, [&](const auto& s) { return !std::binary_search(pairs.begin(), pairs.end(), s.first); });
      for (const BodyPair& pair : pairs) {
        const int begin = since.try_emplace(pair, fine).first->second;
        if (fine - begin != 10) continue;
        ++overlaps;
        const int step = (begin + 9) / 10;  // the first one not before it
        ASSERT_TRUE(reports.count(step)) << seed;
        ASSERT_TRUE(std::binary_search(reports.at(step).begin(), reports.at(step).end(), pair)) << seed;
      }
    }
  }
  EXPECT_GT(overlaps, 300);
}

// What counts is how fast they are relative to each other; static bodies among them do no harm.
TEST(BroadPhase, AsksACrowdThatFliesTheSameWayAboutAsSeldomAsOneAtRest) {
  const auto asked = [](const Vec3& wind, bool statics) {
    const MovingBodies bodies({.bodies = 400, .ball = 75, .period = 1, .end = 3, .wind = wind}, 1);
    BroadPhase world(bodies.source(), {});
    for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
    std::vector<Motion> places;
    std::size_t found = 0, there = 0;
    for (int step = 0; step < 300; ++step) {
      const double t = 0.01 * step;
      if (statics && step % 30 == 29) {  // in the way
        places.emplace_back().position = bodies.motion(static_cast<BodyIndex>(step), t + 0.1).position;
        places.back().radius = 1;
        world.add_static(places.back());
      }
      found += world.advance(t).pairs.size();
      there += bodies.touching(t).size();
      for (const Motion& place : places) {
        for (BodyIndex i = 0; i < bodies.size(); ++i) there += spheres_touch(place, bodies.motion(i, t));
      }
    }
    EXPECT_EQ(found, there);
    return static_cast<double>(world.motions_asked());
  };
  const double at_rest = asked({}, false);
  EXPECT_LT(asked({1000, -300, 50}, false), 1.3 * at_rest);
  EXPECT_GT(asked({1000, -300, 50}, true), at_rest);
}

TEST(BroadPhase, SleepsWhileNothingCanHappen) {
  const WorldShape shape{.bodies = 2, .ball = 200, .max_acceleration = 0.1};
  const MovingBodies bodies(shape, 3);
  BroadPhase world(bodies.source(), {});
  world.add(), world.add();
  const Advance now = world.advance(0);
  EXPECT_TRUE(now.pairs.empty());
  EXPECT_GT(now.time, 0.5);
  const std::uint64_t asked = world.motions_asked();
  for (int i = 0; 0.01 * (i + 1) < now.time; ++i) EXPECT_EQ(world.advance(0.01 * i).time, now.time);
  EXPECT_EQ(world.motions_asked(), asked);
}

TEST(BroadPhase, PortableAndVectorLoopsDoTheSame) {
  const WorldShape shape{.bodies = 3000, .ball = 60, .staggered = true};
  const MovingBodies bodies(shape, 5);
  const auto transcript = [&](bool portable) {
    const auto machine = test::on_portable_machine(portable);
    BroadPhase world(bodies.source());
    for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
    std::vector<std::uint64_t> log;
    for (int i = 0; i <= 50; ++i) {
      const double t = 0.01 * i;
      for (Advance now = world.advance(t); !now.pairs.empty(); now = world.advance(t)) log.push_back(now.pairs.size());
      log.push_back(world.motions_asked());
    }
    return log;
  };
  EXPECT_EQ(transcript(false), transcript(true));
}

TEST(BroadPhase, HandlesAlignedAndDegenerateConfigurations) {
  std::vector<Motion> values(60);
  for (std::size_t i = 0; i < values.size(); ++i) {
    Motion& m = values[i];
    const std::size_t row = i / 10, column = i % 10;
    m.position = {0, static_cast<double>(column) * 2, static_cast<double>(row) * 2};  // spheres that just touch
    m.radius = i % 3 == 0 ? 0 : 1;
    m.velocity = {1, 0, 0};  // all the same
  }
  values[7] = values[5];  // coincident
  for (const test::AnyMethod method : test::kMethods) {
    BroadPhase world = test::make_broad_phase(values_of(values), {.method = method});
    for (std::size_t i = 0; i < values.size(); ++i) world.add();
    std::vector<BodyPair> expected;
    for (BodyIndex i = 0; i < values.size(); ++i) {
      for (BodyIndex j = i + 1; j < values.size(); ++j) {
        if (spheres_touch(values[i], values[j])) expected.push_back({i, j});
      }
    }
    for (int step = 0; step < 3; ++step) {
      const Advance now = world.advance(0.01 * step);
      ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected) << static_cast<int>(method);
    }
  }
}

TEST(BroadPhase, HandlesFarOffsetsAndExtremeScales) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double offset : {0.0, 1e3, 1e9}) {
      const MovingBodies bodies({.bodies = 40, .ball = 12}, 11);
      const MotionSource moved = [&](double time, std::span<const BodyIndex> ids, std::span<Motion> motions) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
          Motion m = bodies.motion(ids[i], time);
          m.position = scale * (m.position + Vec3{offset, -offset, offset});
          m.velocity = scale * m.velocity;
          m.radius *= scale, m.acceleration *= scale;
          motions[i] = m;
        }
      };
      for (const test::AnyMethod method : test::kMethods) {
        BroadPhase world = test::make_broad_phase(moved, {.method = method});
        for (int i = 0; i < 40; ++i) world.add();
        std::vector<Motion> motions(40);
        std::vector<BodyIndex> ids(40);
        for (BodyIndex i = 0; i < 40; ++i) ids[i] = i;
        for (int step = 0; step < 60; ++step) {
          const Advance now = world.advance(0.01 * step);
          moved(0.01 * step, ids, motions);
          std::vector<BodyPair> expected;
          for (BodyIndex i = 0; i < 40; ++i) {
            for (BodyIndex j = i + 1; j < 40; ++j) {
              if (spheres_touch(motions[i], motions[j])) expected.push_back({i, j});
            }
          }
          ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected)
              << "method " << static_cast<int>(method) << " scale " << scale << " offset " << offset << " step "
              << step;
        }
      }
    }
  }
}

// What a source gives at each step has to be what is reported, by comparing all.
void expect_right(const MotionSource& source, std::size_t n, const test::AnyOptions& options, int steps) {
  BroadPhase world = test::make_broad_phase(source, options);
  std::vector<BodyIndex> ids(n);
  for (BodyIndex& id : ids) id = world.add().index;
  std::vector<Motion> motions(n);
  for (int step = 0; step < steps; ++step) {
    const double time = options.common.time_step * step;
    const Advance now = world.advance(time);
    source(time, ids, motions);
    std::vector<BodyPair> expected;
    for (BodyIndex i = 0; i < n; ++i) {
      for (BodyIndex j = i + 1; j < n; ++j) {
        if (spheres_touch(motions[i], motions[j])) expected.push_back({i, j});
      }
    }
    ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected)
        << "method " << static_cast<int>(options.method) << " step " << step;
  }
}

TEST(BroadPhase, WorksFromSpeedBoundsAlone) {  // 8.2: bodies that turn at will, in no time
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Draw draw(seed);
    constexpr double kSpeed = 6;
    constexpr std::size_t kSteps = 80, kBodies = 25;
    std::vector<std::vector<Vec3>> paths(kBodies);
    for (auto& path : paths) {
      path.push_back(draw.in_ball(8));
      for (std::size_t k = 0; k < kSteps; ++k) {
        path.push_back(path.back() + (kStep * draw.uniform(0, kSpeed)) * draw.direction());
      }
    }
    const MotionSource source = [&](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
      const auto step = static_cast<std::size_t>(std::lround(time / kStep));
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        motions[i] = speed_bounded(paths[bodies[i]][step], 0.7, kSpeed, std::numeric_limits<double>::infinity());
      }
    };
    for (const test::AnyMethod method : test::kMethods) {
      expect_right(source, kBodies, {.method = method, .common = {.time_step = kStep}}, kSteps);
      if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
  }
}

TEST(BroadPhase, HandlesClustersStragglersAndAllSizes) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    test::Draw draw(seed);
    const test::MovingBodies near({.bodies = 150, .ball = 6, .min_radius = 0.01, .max_radius = 0.4}, seed);
    std::vector<Vec3> homes(150);
    std::vector<double> sizes(150);
    for (std::size_t i = 0; i < homes.size(); ++i) {
      homes[i] = i % 3 == 0 ? Vec3{} : i % 3 == 1 ? Vec3{1e4, 0, 0} : draw.in_ball(1e5);
      sizes[i] = std::pow(10, draw.uniform(-3, seed % 2 == 0 ? 0 : 3));  // from points to larger than the clusters
    }
    const MotionSource source = [&](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        motions[i] = near.motion(bodies[i], time);
        motions[i].position = motions[i].position + homes[bodies[i]];
        motions[i].radius *= sizes[bodies[i]];
      }
    };
    for (const std::uint32_t window : {0u, 7u}) expect_right(source, 150, {.common = {.window = window}}, 90);
    if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
  }
}

}  // namespace
}  // namespace orchard::runtime
