// The broad phase against a rebuilt spatial hash, sweep and prune, FCL and Bullet on the same moving spheres, in one
// run:
//   broad_phase_bench [table|variations|worst|budgets|threads] [most bodies]
// 300 steps of 0.01 s. Times are of detection only, the motion is the application's; of each step the fastest of some
// runs, summed. All have to report the same pairs at every step.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "measure.h"
#include "rivals.h"
#include "spatial_hash.h"
#include "thread_pool.h"

namespace {

using namespace orchard::bench;
using orchard::runtime::BroadPhase;
using orchard::runtime::BroadPhaseOptions;

constexpr int kSteps = 300;

using Make = std::function<std::function<std::span<const BodyPair>(const Scene&)>(Scene&, Result&)>;

Result measure_once(const SceneShape& shape, int steps, const Make& make, bool wall_clock) {
  const Stopwatch watch(shape.bodies >= 10000 && !wall_clock);
  Scene scene(shape, 7);
  Result result;
  const auto find = make(scene, result);
  for (int step = 0; step < steps; ++step) {
    const double begin = watch.begin();
    const auto pairs = find(scene);
    result.steps.push_back(watch.since(begin));
    result.pairs.push_back(checksum(pairs));
    scene.next_step();
  }
  find(scene);  // lets it note its memory
  result.whole = steps == kSteps;
  return result;
}

Result measure(const SceneShape& shape, int runs, int steps, const Make& make) {
  Result best;
  for (int run = 0; run < runs; ++run) best.keep_fastest(measure_once(shape, steps, make, false));
  return best;
}

// They take turns, so that other work on the machine is shared.
std::vector<Result> measure_in_turn(const SceneShape& shape, int runs, int steps, const std::vector<Make>& makes,
                                    bool wall_clock = false) {
  std::vector<Result> best(makes.size());
  for (int run = 0; run < runs; ++run) {
    for (std::size_t k = 0; k < makes.size(); ++k) {
      best[k].keep_fastest(measure_once(shape, steps, makes[k], wall_clock));
    }
  }
  return best;
}

Make ours(const BroadPhaseOptions& options) {
  return [options](Scene& scene, Result& result) {
    auto world = std::make_shared<BroadPhase>(scene.source(), options);
    for (std::size_t i = 0; i < scene.size(); ++i) world->add();
    return [world, &result](const Scene& s) {
      const auto report = world->advance(s.time());
      if (result.steps.size() + 1 >= kSteps)
        result.memory = world->memory_bytes(), result.asked = world->motions_asked();
      return report.pairs;
    };
  };
}

Make rival(const std::function<std::unique_ptr<Rival>(const Scene&)>& make) {
  return [make](Scene& scene, Result& result) {
    std::shared_ptr<Rival> it = make(scene);
    auto pairs = std::make_shared<std::vector<BodyPair>>();
    return [it, pairs, &result](const Scene&) {
      pairs->clear();
      it->find(*pairs);
      result.memory = it->memory_bytes();
      return std::span<const BodyPair>(*pairs);
    };
  };
}

double spacing_of(const SceneShape& shape) { return 200 * std::cbrt(4 * 3.14159265358979 / 3 / (100 * shape.density)); }

Make tuned_hash(const SceneShape& shape) {
  const Scene scene(shape, 7);
  const double cell = SpatialHash::best_cell_size(scene.positions(), scene.radii(), spacing_of(shape), {});
  return rival([cell](const Scene& s) {
    return std::make_unique<SpatialHash>(s.positions(), s.radii(), SpatialHash::Options{cell});
  });
}

int runs_for(std::size_t bodies) { return bodies <= 1000 ? 15 : bodies <= 10000 ? 5 : 3; }

int table(std::size_t most) {
  bool right = true;
  std::printf(
      "| bodies | density | orchard, ms | spatial hash | sweep and prune | FCL tree | Bullet Dbvt | bytes/body | "
      "motions asked |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t n = 100; n <= most; n *= 10) {
    for (const double density : {1.0, 10.0}) {
      const SceneShape shape{.bodies = n, .density = density};
      const int runs = runs_for(n);
      const auto results = measure_in_turn(shape, runs, kSteps, {tuned_hash(shape), ours({})});
      const Result &hash = results[0], &own = results[1];
      right = same("orchard", own, hash) && right;
      std::printf("| %zu | %.0f | %.3f | %.3f: %.1f times | ", n, density, 1e3 * own.total(), 1e3 * hash.total(),
                  hash.total() / own.total());
      const auto other = [&](const char* name, int steps,
                             const std::function<std::unique_ptr<Rival>(const Scene&)>& make) {
        const Result r = measure(shape, n <= 1000 ? 3 : 1, steps, rival(make));
        right = same(name, r, hash) && right;
        const double total = r.total() * kSteps / steps;
        std::printf("%s%.1f: %.0f times | ", r.whole ? "" : "about ", 1e3 * total, total / own.total());
        std::fflush(stdout);
      };
      other("sweep and prune", n > 10000 ? 30 : kSteps,
            [](const Scene& s) { return sweep_and_prune(s.positions(), s.radii()); });
#ifdef ORCHARD_HAS_FCL
      other("FCL", n > 10000 ? 30 : kSteps, [](const Scene& s) { return fcl_tree(s.positions(), s.radii()); });
#else
      std::printf("- | ");
#endif
#ifdef ORCHARD_HAS_BULLET
      other("Bullet",
            n > 10000  ? 10
            : n > 1000 ? 60
                       : kSteps,
            [](const Scene& s) { return bullet_dbvt(s.positions(), s.radii()); });
#else
      std::printf("- | ");
#endif
      std::printf("%.0f | %.2f per body |\n", static_cast<double>(own.memory) / static_cast<double>(n),
                  static_cast<double>(own.asked) / static_cast<double>(n));
    }
  }
  return right ? 0 : 1;
}

int variations(std::size_t most) {
  struct Case {
    const char* name;
    double density, speed, acceleration;
  };
  bool right = true;
  std::printf(
      "| bodies | scene | orchard, ms | spatial hash | with a fixed window of 100 steps |\n|---|---|---|---|---|\n");
  for (std::size_t n = 1000; n <= most; n *= 10) {
    for (const Case& c : {Case{"100 times as dense", 100, 1, 1}, Case{"4 times as fast", 1, 4, 1},
                          Case{"10 times M", 1, 1, 10}, Case{"all three", 100, 4, 10}}) {
      const SceneShape shape{.bodies = n, .density = c.density, .speed = c.speed, .acceleration = c.acceleration};
      const auto results = measure_in_turn(shape, runs_for(n), kSteps, {tuned_hash(shape), ours({})});
      const Result &hash = results[0], &own = results[1];
      const Result fixed = measure(shape, 1, kSteps, ours({.window = 100}));
      right = same("orchard", own, hash) && same("fixed window", fixed, hash) && right;
      std::printf("| %zu | %s | %.3f | %.3f: %.1f times | %.1f times |\n", n, c.name, 1e3 * own.total(),
                  1e3 * hash.total(), hash.total() / own.total(), hash.total() / fixed.total());
      std::fflush(stdout);
    }
  }
  return right ? 0 : 1;
}

int worst(std::size_t most) {
  bool right = true;
  std::printf(
      "| bodies | density | bounds | first step, ms | spatial hash's first | worst later step, ms | spatial hash's "
      "worst | total, ms | spatial hash |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t n = 100; n <= most; n *= 10) {
    for (const double density : {1.0, 10.0}) {
      for (const bool staggered : {false, true}) {
        const SceneShape shape{.bodies = n, .density = density, .staggered = staggered};
        const auto results = measure_in_turn(shape, runs_for(n), kSteps, {tuned_hash(shape), ours({})});
        const Result &hash = results[0], &own = results[1];
        right = same("orchard", own, hash) && right;
        std::printf(
            "| %zu | %.0f | %s | %.4f | %.4f: %.2f times | %.4f | %.4f: %.2f times | %.3f | %.3f: %.1f times |\n", n,
            density, staggered ? "staggered" : "expire together", 1e3 * own.steps[0], 1e3 * hash.steps[0],
            hash.steps[0] / own.steps[0], 1e3 * own.worst(1), 1e3 * hash.worst(1), hash.worst(1) / own.worst(1),
            1e3 * own.total(), 1e3 * hash.total(), hash.total() / own.total());
        std::fflush(stdout);
      }
    }
  }
  return right ? 0 : 1;
}

// What is found of the overlaps where every step is given the same budget: counted, so it is the same on any machine.
int budgets(std::size_t bodies) {
  const SceneShape shape{.bodies = bodies};
  constexpr int kStepsHere = kSteps + 1;  // the last one is that at which bounds expire for the third time
  std::printf("| units per step | overlaps reported | steps that are incomplete |\n|---|---|---|\n");
  for (const std::uint64_t units : {30u, 100u, 200u, 500u, 1000u, 4500u, 20000u}) {
    Scene scene(shape, 7);
    BroadPhase limited(scene.source(), {}), whole(scene.source(), {});
    for (std::size_t i = 0; i < bodies; ++i) limited.add(), whole.add();
    std::size_t found = 0, there = 0, incomplete = 0;
    for (int step = 0; step < kStepsHere; ++step, scene.next_step()) {
      const auto report = limited.advance(scene.time(), {.work = units});
      found += report.pairs.size();
      incomplete += report.incomplete_from != orchard::runtime::kNoClass;
      there += whole.advance(scene.time()).pairs.size();
    }
    std::printf("| %llu | %.1f %% | %zu of %d |\n", static_cast<unsigned long long>(units),
                100 * static_cast<double>(found) / static_cast<double>(there), incomplete, kStepsHere);
  }
  return 0;
}

// By the wall's clock, of each step the fastest run.
int threads(std::size_t most) {
  bool right = true;
  std::printf("| bodies | density | no executor, ms | 1 thread | 2 threads | 2 threads, awake for 2 ms | ");
  std::printf("worst later step, ms | on 2 threads | awake |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t n = 10000; n <= most; n *= 10) {
    for (const double density : {1.0, 10.0}) {
      const SceneShape shape{.bodies = n, .density = density};
      const int runs = n <= 100000 ? 15 : 2, steps = n <= 100000 ? kSteps : 120;
      orchard::runtime::test::ThreadPool one(1), two(2), awake(2, std::chrono::milliseconds(2));
      const auto with = [](const orchard::runtime::Executor& executor) {
        BroadPhaseOptions options;
        options.executor = executor;
        return ours(options);
      };
      const auto results = measure_in_turn(
          shape, runs, steps, {ours({}), with(one.executor()), with(two.executor()), with(awake.executor())}, true);
      const Result& none = results[0];
      std::printf("| %zu | %.0f | %.3f | ", n, density, 1e3 * none.total());
      for (const Result& result : {results[1], results[2], results[3]}) {
        right = same("with threads", result, none) && right;
        std::printf("%.3f: %.2f times as fast | ", 1e3 * result.total(), none.total() / result.total());
      }
      std::printf("%.3f |", 1e3 * none.worst(1));
      for (const Result& result : {results[2], results[3]})
        std::printf(" %.3f: %.2f times |", 1e3 * result.worst(1), none.worst(1) / result.worst(1));
      std::printf("\n");
      std::fflush(stdout);
    }
  }
  return right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "table";
  const std::size_t most = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 100000;
  if (what == "table") return table(most);
  if (what == "variations") return variations(most);
  if (what == "worst") return worst(most);
  if (what == "budgets") return budgets(most);
  if (what == "threads") return threads(most);
  std::fprintf(stderr, "usage: broad_phase_bench [table|variations|worst|budgets|threads] [most bodies]\n");
  return 2;
}
