#include "cubes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

namespace orchard::bench {
namespace {

using runtime::dot;

constexpr int kForces = 5;          // in a period
constexpr double kAccuracy = 1e-9;  // of a position after a step

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Place {
  Vec3 position, velocity;
};

Place runge_kutta(const Place& from, const Vec3& force, double h) {
  const auto slope = [&](const Vec3& v) { return std::pair<Vec3, Vec3>{v, force}; };
  const auto [x1, v1] = slope(from.velocity);
  const auto [x2, v2] = slope(from.velocity + (h / 2) * v1);
  const auto [x3, v3] = slope(from.velocity + (h / 2) * v2);
  const auto [x4, v4] = slope(from.velocity + h * v3);
  return {from.position + (h / 6) * (x1 + 2.0 * x2 + 2.0 * x3 + x4),
          from.velocity + (h / 6) * (v1 + 2.0 * v2 + 2.0 * v3 + v4)};
}

// Step doubling, as in chapter 16.2 of Numerical Recipes: a step and two halves of it. Moves `place` on by `step` or
// less, returns by how much, and leaves in `step` what to try next.
double adaptive_step(Place& place, const Vec3& force, double& step) {
  while (true) {
    const double h = step;
    const Place once = runge_kutta(place, force, h);
    const Place twice = runge_kutta(runge_kutta(place, force, h / 2), force, h / 2);
    const Vec3 apart = twice.position - once.position;
    const double error = std::sqrt(dot(apart, apart)) / kAccuracy;
    if (error > 1) {
      step = h * std::max(0.1, 0.9 * std::pow(error, -0.25));
      continue;
    }
    step = h * std::min(4.0, 0.9 * std::pow(std::max(error, 1e-4), -0.2));
    place = twice;
    return h;
  }
}

}  // namespace

Cubes::Period Cubes::period_after(const Period& last, Relation relation, runtime::test::Draw& draw) {
  constexpr double kTurn = 0.5, kChange = 0.1;  // sine of 30 degrees; share
  switch (relation) {
    case Relation::steady:
      return last;
    case Relation::turning: {
      const Vec3 turned = last.half_space + draw.uniform(0, kTurn) * draw.direction();
      return {last.bound * draw.uniform(1 - kChange, 1 + kChange), (1 / std::sqrt(dot(turned, turned))) * turned};
    }
    case Relation::alternating:
      return {last.bound, -1.0 * last.half_space};
    case Relation::none:
    case Relation::shared:
      break;
  }
  return {draw.uniform(0, 4), draw.direction()};
}

Cubes::Cubes(const CubeScene& scene) {
  runtime::test::Draw draw(scene.seed);
  std::vector<Period> shared;
  for (std::size_t i = 0; i < scene.count; ++i) {
    Cube cube{draw.in_ball(scene.ball), draw.uniform(5, 15) * draw.direction(), 0, kDetection, {}, {}};
    for (double begin = 0; begin < kEnd + kPeriod; begin += kPeriod) {
      const std::size_t p = cube.periods.size();
      Period period =
          period_after(p == 0 ? Period{} : cube.periods.back(), p == 0 ? Relation::none : scene.relation, draw);
      if (scene.relation == Relation::shared && i > 0) period = shared[p];
      for (int f = 0; f < kForces; ++f) {
        const Vec3 force = draw.uniform(0, period.bound) * draw.direction();
        cube.forces.push_back(dot(force, period.half_space) > 0 ? -1.0 * force : force);
      }
      cube.periods.push_back(period);
    }
    if (i == 0) shared = cube.periods;
    cubes_.push_back(std::move(cube));
    halves.push_back(draw.uniform(0.5, 1.5));
  }
  positions.resize(scene.count);
}

void Cubes::solve_all(double time) {
  const double begin = now();
  for (std::size_t i = 0; i < size(); ++i) positions[i] = solved(i, time).position;
  solver_seconds += now() - begin;
}

runtime::MotionSource Cubes::source() {
  return [this](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    const double begin = now();
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Cube& cube = solved(bodies[k], time);
      const auto p = static_cast<std::size_t>((time + 1e-9) / kPeriod);
      Motion& m = motions[k];
      m = Motion{};
      m.position = cube.position;
      m.velocity = cube.velocity;
      m.radius = std::sqrt(3.0) * halves[bodies[k]];
      m.acceleration = cube.periods[p].bound;
      m.half_space = cube.periods[p].half_space;
      m.expiry = static_cast<double>(p + 1) * kPeriod;
    }
    solver_seconds += now() - begin;
  };
}

bool Cubes::collide(BodyIndex a, BodyIndex b, double time) {
  const double begin = now();
  const Vec3 apart = solved(a, time).position - solved(b, time).position;
  solver_seconds += now() - begin;
  bool meet = true;
  for (std::size_t d = 0; d < 3; ++d) meet = meet && std::fabs(apart[d]) <= halves[a] + halves[b];
  return meet;
}

// The steps end where the force changes and at the time asked for; between them they are as long as the accuracy
// allows.
const Cubes::Cube& Cubes::solved(std::size_t i, double time) {
  Cube& cube = cubes_[i];
  const double interval = kPeriod / kForces;
  while (cube.time < time - 1e-12) {
    const auto f = static_cast<std::size_t>((cube.time + 1e-9) / interval);
    const double left = std::min(time, static_cast<double>(f + 1) * interval) - cube.time;
    double step = std::min(left, cube.step);
    Place place{cube.position, cube.velocity};
    cube.time += adaptive_step(place, cube.forces[f], step);
    cube.step = left < cube.step ? std::max(step, cube.step) : step;  // one cut short says nothing against longer ones
    cube.position = place.position;
    cube.velocity = place.velocity;
  }
  return cube;
}

// Calls detect(frame's time), which returns the time of a collision or a negative number, and takes the times apart.
static Run run(Cubes& cubes, double end, bool stop, const std::function<double(double)>& detect) {
  Run result;
  const int frames = static_cast<int>(std::lround(end / kFrame));
  for (int frame = 0; frame <= frames; ++frame) {
    const double time = frame * kFrame, solver_before = cubes.solver_seconds, begin = now();
    const double collision = detect(time);
    const double middle = now();
    result.frames.push_back(std::max(0.0, middle - begin - (cubes.solver_seconds - solver_before)));
    result.detection += result.frames.back();
    cubes.solve_all(time);  // to draw them
    result.overall += now() - begin;
    if (collision >= 0 && stop) {
      result.collision = collision;
      break;
    }
  }
  return result;
}

Run run_bounds(const CubeScene& scene, const MakeBroadPhase& make, double end, bool stop) {
  Cubes cubes(scene);
  runtime::BroadPhase world = make(cubes.source());
  for (std::size_t i = 0; i < scene.count; ++i) world.add();
  Run result = run(cubes, end, stop, [&](double time) {
    double first = -1;
    for (auto report = world.advance(time); !report.pairs.empty(); report = world.advance(time)) {
      for (const BodyPair& pair : report.pairs) {
        if (!cubes.collide(pair.a, pair.b, report.time)) continue;
        if (stop) return report.time;
        first = first < 0 ? report.time : first;
      }
    }
    return first;
  });
  result.memory = world.memory_bytes();
  result.asked = world.motions_asked();
  return result;
}

Run run_rival(const CubeScene& scene, const MakeRival& make, double end, bool stop) {
  Cubes cubes(scene);
  cubes.solve_all(0);
  cubes.solver_seconds = 0;
  const std::unique_ptr<Rival> rival = make(cubes);
  std::vector<BodyPair> pairs;
  double next = 0;
  Run result = run(cubes, end, stop, [&](double time) {
    for (; next <= time + 1e-9; next += kDetection) {
      cubes.solve_all(next);
      pairs.clear();
      rival->find(pairs);
      if (!pairs.empty() && stop) return next;
    }
    return -1.0;
  });
  result.memory = rival->memory_bytes();
  return result;
}

MakeRival hash_of(std::size_t memory, double cell) {
  return [=](const Cubes& cubes) {
    const std::size_t entries = cubes.size() * 48;  // what the bodies themselves need
    const std::size_t table = memory == 0 ? 0 : std::max<std::size_t>(256, memory > entries ? memory - entries : 0);
    return std::make_unique<SpatialHash>(cubes.positions, cubes.halves, SpatialHash::Options{cell, table, true});
  };
}

double best_cell(const CubeScene& scene) {
  Cubes cubes(scene);
  cubes.solve_all(0);
  const double spacing = scene.ball * std::cbrt(4.18879 / static_cast<double>(scene.count));
  return SpatialHash::best_cell_size(cubes.positions, cubes.halves, spacing, {1, 0, true});
}

MakeRival octree_of(MovingOctree::Upkeep upkeep) {
  return [=](const Cubes& cubes) {
    return std::make_unique<MovingOctree>(cubes.positions, cubes.halves, MovingOctree::Options{upkeep, true});
  };
}

}  // namespace orchard::bench
