#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/motion.h"
#include "runtime/numbers.h"
#include "split_mix.h"
#include "support/effort.h"
#include "thread_pool.h"

// Updates of all windows by an executor's jobs: so many bodies that they are shared, of every kind that jobs treat
// apart.
namespace orchard::runtime {
namespace {

using test::kStep;
constexpr std::size_t kBodies = 20000;

// Straight paths, known in closed form, so that sources of all threads only read.
class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) {
    test::SplitMix draw(seed);
    const double size = draw.uniform(60, 140);
    for (std::size_t i = 0; i < kBodies; ++i) {
      Motion m;
      for (std::size_t d = 0; d < 3; ++d) {
        m.position[d] = draw.uniform(-size, size);
        m.velocity[d] = draw.uniform(-15, 15);
      }
      m.radius = draw.uniform(0, 1) < 0.01 ? draw.uniform(10, 25) : draw.uniform(0.5, 1.5);
      m.acceleration = draw.uniform(0, 4);
      start_.push_back(m);
      // Most bounds end together, others at times of their own; and a few motions are not valid at first.
      period_.push_back(draw.uniform(0, 1) < 0.9 ? 0.08 : draw.uniform(0.02, 0.3));
      valid_from_.push_back(draw.uniform(0, 1) < 0.005 ? draw.uniform(0, 0.2) : 0);
    }
  }

  Motion motion(BodyIndex body, double time) const {
    Motion m = start_[body];
    m.position = m.position + time * m.velocity;
    m.expiry = (std::floor(time / period_[body] + 1e-6) + 1) * period_[body];
    if (time < valid_from_[body]) m.radius = std::numeric_limits<double>::quiet_NaN();
    return m;
  }
  MotionSource source() const {
    return [this](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
      for (std::size_t i = 0; i < bodies.size(); ++i) motions[i] = motion(bodies[i], time);
    };
  }

 private:
  std::vector<Motion> start_;
  std::vector<double> period_, valid_from_;
};

struct World {
  bool statics = false, filters = false, user_filter = false;
};

BodyFilter filter_of(const World& world, BodyIndex body) {
  if (!world.filters) return {};
  return {.category = 1u << body % 3, .mask = body % 5 == 0 ? 3u : 7u, .ignores_static = body % 11 == 0};
}
bool user_allows(BodyIndex a, BodyIndex b) { return (a + b) % 4 != 0; }
bool is_static(const World& world, BodyIndex body) { return world.statics && body % 7 == 0; }

std::vector<std::vector<BodyPair>> reports(const Crowd& crowd, const World& world, const Executor& executor,
                                           int steps) {
  BroadPhaseOptions options;
  options.time_step = kStep;
  options.executor = executor;
  BroadPhase broad(crowd.source(), options);
  for (BodyIndex body = 0; body < kBodies; ++body) {
    Motion place = crowd.motion(body, 0);
    if (is_static(world, body) && !is_valid(place)) place.radius = 1;
    is_static(world, body) ? broad.add_static(place, 0, filter_of(world, body)) : broad.add(0, filter_of(world, body));
  }
  if (world.user_filter) broad.set_pair_filter([](BodyId a, BodyId b) { return user_allows(a.index, b.index); });
  std::vector<std::vector<BodyPair>> all;
  for (int step = 0; step < steps; ++step) {
    const Advance now = broad.advance(step * kStep);
    all.emplace_back(now.pairs.begin(), now.pairs.end());
    // Some bounds are said to hold no longer; that changes nothing that is true.
    for (BodyIndex body = static_cast<BodyIndex>(step); body < kBodies; body += 997) broad.cancel(broad.id_of(body));
  }
  return all;
}

// By sweeping along an axis.
std::vector<BodyPair> by_sweep(const Crowd& crowd, const World& world, double time) {
  struct Ball {
    double lower;
    BodyIndex body;
    Motion motion;
  };
  std::vector<Ball> balls;
  double largest = 0;
  for (BodyIndex body = 0; body < kBodies; ++body) {
    const bool fixed = is_static(world, body);
    Motion m = crowd.motion(body, fixed ? 0 : time);
    if (!is_valid(m)) {
      if (!fixed) continue;
      m.radius = 1;
    }
    largest = std::max(largest, m.radius);
    balls.push_back({m.position[0] - m.radius, body, m});
  }
  std::sort(balls.begin(), balls.end(), [](const Ball& a, const Ball& b) { return a.lower < b.lower; });
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double end = balls[i].motion.position[0] + balls[i].motion.radius + 1e-9;
    for (std::size_t k = i + 1; k < balls.size() && balls[k].lower <= end; ++k) {
      const BodyIndex a = std::min(balls[i].body, balls[k].body), b = std::max(balls[i].body, balls[k].body);
      if (!spheres_touch(balls[i].motion, balls[k].motion)) continue;
      if (is_static(world, a) && is_static(world, b)) continue;
      if (!may_pair(filter_of(world, a), filter_of(world, b))) continue;
      if ((filter_of(world, a).ignores_static && is_static(world, b)) ||
          (filter_of(world, b).ignores_static && is_static(world, a)))
        continue;
      if (world.user_filter && !user_allows(a, b)) continue;
      pairs.push_back({a, b});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(BroadPhaseThreads, GiveThePairsOfASweepWhateverTheirNumber) {
  constexpr int kSteps = 17;  // in which most bounds end together twice
  // In the first of these worlds a common expiry is prepared with boxes that are too large for the grid, and so many
  // bodies left to its own step that they are updated by jobs.
  std::vector<std::uint64_t> seeds = {1'000'000'004};
  for (std::uint64_t i = 1; i <= orchard::test::more(); ++i) seeds.push_back(orchard::test::first_seed() + i);
  for (const std::uint64_t seed : seeds) {
    const Crowd crowd(seed);
    for (const World& world : {World{.statics = true, .filters = true}, World{.user_filter = true}}) {
      const auto serial = reports(crowd, world, {}, kSteps);
      std::size_t pairs = 0;
      for (int step = 0; step < kSteps; step += 4) {
        ASSERT_EQ(serial[static_cast<std::size_t>(step)], by_sweep(crowd, world, step * kStep)) << seed << ", " << step;
        pairs += serial[static_cast<std::size_t>(step)].size();
      }
      EXPECT_GT(pairs, 1000u);
      for (const std::size_t threads : {2u, 3u}) {
        if (threads == 2 && orchard::test::more() == 1) continue;  // the thread sanitizer takes its time
        test::ThreadPool pool(threads);
        ASSERT_TRUE(reports(crowd, world, pool.executor(), kSteps) == serial) << seed << ", " << threads << " threads";
      }
    }
  }
}

// What a budget cuts short in counted work is the same, too: jobs leave everything in the order of a single thread.
TEST(BroadPhaseThreads, LeaveTheSameToABudget) {
  const Crowd crowd(orchard::test::first_seed() + 99);
  const auto run = [&](const Executor& executor) {
    BroadPhaseOptions options;
    options.time_step = kStep;
    options.executor = executor;
    BroadPhase broad(crowd.source(), options);
    for (std::size_t i = 0; i < kBodies; ++i) broad.add();
    std::vector<std::vector<BodyPair>> all;
    for (int step = 0; step < 12; ++step) {
      const bool whole = step % 8 == 0;
      const Advance now = whole ? broad.advance(step * kStep) : broad.advance(step * kStep, {.work = 2000});
      all.emplace_back(now.pairs.begin(), now.pairs.end());
    }
    return all;
  };
  const auto serial = run({});
  test::ThreadPool pool(3);
  EXPECT_TRUE(run(pool.executor()) == serial);
}

}  // namespace
}  // namespace orchard::runtime
