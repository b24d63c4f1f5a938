// What integrators make of motion that keeps its bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "any_broad_phase.h"
#include "orchard/runtime/motion_helpers.h"
#include "worlds.h"

namespace orchard::runtime {
namespace {

constexpr Integrator kIntegrators[] = {Integrator::explicit_euler,
                                       Integrator::semi_implicit_euler,
                                       Integrator::implicit_euler,
                                       Integrator::velocity_verlet,
                                       Integrator::position_verlet,
                                       Integrator::staggered_leapfrog,
                                       Integrator::stoermer,
                                       Integrator::midpoint,
                                       Integrator::heun,
                                       Integrator::runge_kutta_4};

struct State {
  Vec3 position, velocity;  // the velocity that the application would give
};

// Steps of an integrator, its accelerations from `draw`: nothing is assumed of them but their bound.
class Simulation {
 public:
  Simulation(Integrator integrator, double dt, const State& start, std::function<Vec3()> draw)
      : integrator_(integrator), h_(dt), state_(start), draw_(std::move(draw)), next_(draw_()) {}

  const State& state() const { return state_; }

  void step() {
    Vec3 &x = state_.position, &v = state_.velocity;
    const Vec3 a = next_;
    next_ = draw_();
    const double h = h_;
    switch (integrator_) {
      case Integrator::explicit_euler:
        x = x + h * v;
        v = v + h * a;
        break;
      case Integrator::semi_implicit_euler:
      case Integrator::staggered_leapfrog:
      case Integrator::implicit_euler:
        v = v + h * a;
        x = x + h * v;
        break;
      case Integrator::velocity_verlet:
        x = x + h * v + (h * h / 2) * a;
        v = v + (h / 2) * (a + next_);
        break;
      case Integrator::position_verlet:
        x = x + (h / 2) * v;
        v = v + h * a;
        x = x + (h / 2) * v;
        break;
      case Integrator::stoermer: {  // v is (x - before) / h
        const Vec3 before = x - h * v, after = 2.0 * x - before + (h * h) * a;
        v = (1 / h) * (after - x);
        x = after;
        break;
      }
      case Integrator::midpoint:
        x = x + h * (v + (h / 2) * a);
        v = v + h * next_;
        next_ = draw_();
        break;
      case Integrator::heun:
        x = x + h * v + (h * h / 2) * a;
        v = v + (h / 2) * (a + next_);
        next_ = draw_();
        break;
      case Integrator::runge_kutta_4: {
        const Vec3 b = next_, c = draw_(), d = draw_();
        const Vec3 v2 = v + (h / 2) * a, v3 = v + (h / 2) * b, v4 = v + h * c;
        x = x + (h / 6) * (v + 2.0 * v2 + 2.0 * v3 + v4);
        v = v + (h / 6) * (a + 2.0 * b + 2.0 * c + d);
        next_ = draw_();
        break;
      }
    }
  }

 private:
  Integrator integrator_;
  double h_;
  State state_;
  std::function<Vec3()> draw_;
  Vec3 next_;
};

// Accelerations of length M: always the same, one that turns, or any.
std::function<Vec3()> extreme_draw(test::Draw& draw, double m, const Vec3& half_space) {
  const int kind = static_cast<int>(draw.bits() % 3);
  const auto allowed = [half_space](const Vec3& a) { return dot(a, half_space) > 0 ? -1.0 * a : a; };
  const Vec3 first = allowed(m * draw.direction());
  return [&draw, m, kind, first, allowed, count = 0]() mutable {
    if (kind == 0) return first;
    if (kind == 1 && ++count < 7) return first;
    return allowed(m * draw.direction());
  };
}

TEST(DriftOf, KeepsBothLemmasForEveryIntegrator) {
  for (const Integrator integrator : kIntegrators) {
    double tightest = 1e300, without = 1e300;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      test::Draw draw(seed);
      const double h = std::pow(10, draw.uniform(-3, -1)), m = std::pow(10, draw.uniform(-2, 2));
      const Vec3 half_space = seed % 2 == 0 ? Vec3{} : draw.direction();
      Simulation simulation(integrator, h, {draw.in_ball(1), m * h * draw.in_ball(3)},
                            extreme_draw(draw, m, half_space));
      const double drift = drift_of(integrator, h, m);
      std::vector<State> path;
      for (int k = 0; k <= 30; ++k) {
        path.push_back(simulation.state());
        simulation.step();
      }
      for (std::size_t from = 0; from < path.size(); from += 5) {
        for (std::size_t to = from + 1; to < path.size(); ++to) {
          const double s = h * static_cast<double>(to - from), room = m * s * s / 2 + drift * s, tiny = 1e-12 * room;
          const Vec3 off = path[to].position - path[from].position - s * path[from].velocity;
          ASSERT_LE(length(off), room + tiny + 1e-12) << static_cast<int>(integrator) << " seed " << seed;
          ASSERT_LE(dot(off, half_space), drift * s + tiny + 1e-12) << static_cast<int>(integrator) << " seed " << seed;
          tightest = std::min(tightest, (room - length(off)) / room);
          without = std::min(without, (m * s * s / 2 - length(off)) / room);
        }
      }
    }
    if (integrator != Integrator::explicit_euler) {
      EXPECT_LT(tightest, 1e-9) << static_cast<int>(integrator);  // no smaller drift would do
    }
    EXPECT_EQ(without<-0.01, drift_of(integrator, 1, 1)> 0) << static_cast<int>(integrator);
  }
}

TEST(DriftOf, BetweenStepsKeepsTheLemmaForPositionsInterpolated) {
  for (const Integrator integrator : kIntegrators) {
    bool needed = false;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      test::Draw draw(seed);
      const double h = 0.01, m = 10, drift = drift_of(integrator, h, m, Sampling::between);
      Simulation simulation(integrator, h, {draw.in_ball(1), draw.in_ball(0.3)}, extreme_draw(draw, m, Vec3{}));
      std::vector<State> path;
      for (int k = 0; k <= 12; ++k) {
        path.push_back(simulation.state());
        simulation.step();
      }
      const auto at = [&](double t) {
        const auto k = static_cast<std::size_t>(t);
        const double share = t - static_cast<double>(k);
        return (1 - share) * path[k].position + share * path[k + 1].position;
      };
      for (int trial = 0; trial < 200; ++trial) {
        const double from = draw.uniform(0, 11), to = draw.uniform(from, 11.99), s = h * (to - from);
        for (const std::size_t later : {0u, 1u}) {  // the velocity before, or after the step under way
          const Vec3 off = at(to) - at(from) - s * path[static_cast<std::size_t>(from) + later].velocity;
          ASSERT_LE(length(off), m * s * s / 2 + drift * s + 1e-13) << static_cast<int>(integrator) << " seed " << seed;
          needed = needed || length(off) > m * s * s / 2 + drift_of(integrator, h, m) * s + 1e-9;
        }
      }
    }
    EXPECT_TRUE(needed) << static_cast<int>(integrator);
  }
}

// Two bodies push towards each other, or from behind, as hard as they may.
test::Misses head_on(Integrator integrator, double drift_share, std::uint64_t seeds, std::uint64_t first,
                     test::AnyMethod method) {
  test::Misses trial;
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    test::Draw draw(seed);
    constexpr double kDt = 0.01;
    const double m = draw.uniform(1, 60), gap = draw.uniform(0.1, 4);
    const Vec3 way = draw.direction();
    std::vector<Motion> values(2);
    std::vector<Simulation> bodies;
    for (int i = 0; i < 2; ++i) {
      const Vec3 push = (i == 0 ? m : -m) * way;
      bodies.emplace_back(integrator, kDt, State{i == 0 ? Vec3{} : (2 + gap) * way, draw.uniform(-0.5, 0.5) * way},
                          [push] { return push; });
      values[static_cast<std::size_t>(i)].radius = 1;
      values[static_cast<std::size_t>(i)].acceleration = m;
      values[static_cast<std::size_t>(i)].drift = drift_share * drift_of(integrator, kDt, m);
    }
    BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = kDt}});
    world.add(), world.add();
    for (int step = 0; step < 60; ++step) {
      for (std::size_t i = 0; i < 2; ++i) {
        values[i].position = bodies[i].state().position;
        values[i].velocity = bodies[i].state().velocity;
        bodies[i].step();
      }
      const std::size_t found = world.advance(kDt * step).pairs.size(), expected = spheres_touch(values[0], values[1]);
      EXPECT_TRUE(found <= expected || drift_share == 0);
      trial.touching += expected;
      trial.missed += found < expected;
    }
  }
  return trial;
}

TEST(DriftOf, IsWhatTheBroadPhaseNeedsToMissNothing) {
  for (const Integrator integrator : kIntegrators) {
    for (const test::AnyMethod method :
         {test::AnyMethod::events, test::AnyMethod::projection, test::AnyMethod::horns}) {
      const test::Misses trial = head_on(integrator, 1, 150, 1, method);
      EXPECT_GT(trial.touching, 1000u);
      EXPECT_EQ(trial.missed, 0u) << static_cast<int>(integrator);
    }
  }
  EXPECT_GT(head_on(Integrator::semi_implicit_euler, 0, 300, 1, test::AnyMethod::events).missed, 0u);
}

}  // namespace
}  // namespace orchard::runtime
