// Section 4.2.8: "it would be interesting to investigate" what cutting planes are worth; it was not.
//   sec_4_2_8_cutting_planes [folder for CSV and SVG] [trials]
// The cubes of 7.1 (cubes.h), 100 of them, until two collide: the same trials with the half-spaces that their forces
// keep to and without, by each way of the broad phase. Ratios without over with: above 1, the planes are worth it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "broad_phase_methods/sleeping_broad_phase.h"
#include "broad_phase_methods/space_time_bound.h"
#include "cubes.h"
#include "svg_plot.h"
#include "worlds.h"

namespace {

using namespace orchard::bench;
using orchard::broad_phase_methods::SleepingMethod;
using orchard::plot::Plot;
using orchard::plot::Series;
using orchard::runtime::BodyIndex;
using orchard::runtime::BroadPhase;
using orchard::runtime::MotionSource;

constexpr std::size_t kCubes = 100;
constexpr double kBall = 107;

MotionSource without_planes(MotionSource source) {
  return [source = std::move(source)](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    source(time, bodies, motions);
    for (Motion& motion : motions) motion.half_space = {};
  };
}

struct Way {
  const char* name;
  MakeBroadPhase make;
};
std::vector<Way> ways() {
  const auto sleeping = [](SleepingMethod method) {
    return [=](MotionSource source) {
      return orchard::broad_phase_methods::make_sleeping_broad_phase(
          std::move(source),
          {method, orchard::broad_phase_methods::Rebuild::what_intersected, {.time_step = kDetection}});
    };
  };
  return {{"projection", sleeping(SleepingMethod::projection)},
          {"subdivision", sleeping(SleepingMethod::subdivision)},
          {"horns", sleeping(SleepingMethod::horns)},
          {"events", [](MotionSource source) { return BroadPhase(std::move(source), {.time_step = kDetection}); }}};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

Run best_of_three(std::uint64_t seed, const MakeBroadPhase& make) {
  Run best = run_bounds({kCubes, kBall, seed}, make);
  for (int round = 0; round < 2; ++round)
    best.detection = std::min(best.detection, run_bounds({kCubes, kBall, seed}, make).detection);
  return best;
}

namespace methods = orchard::broad_phase_methods;
namespace test = orchard::runtime::test;

struct Found {
  double earliest, seconds;
};

Found find(methods::IntersectionFinder& finder, const std::vector<methods::SpaceTimeBound>& bounds, double duration,
           const methods::IntersectionOptions& options) {
  Found found{0, 1e300};
  for (int round = 0; round < 3; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    found.earliest = std::min(finder.find(bounds, duration, options).earliest.time, duration);
    found.seconds =
        std::min(found.seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return found;
}

// With planes and without, from the same motions; apart at the start even by the cubes, which planes do not cut.
std::pair<std::vector<methods::SpaceTimeBound>, std::vector<methods::SpaceTimeBound>> bounds_of(double duration,
                                                                                                double factor,
                                                                                                std::uint64_t seed) {
  test::Draw draw(seed);
  const auto motion = [&] {
    Motion m;
    m.radius = draw.uniform(0.5, 1.5);
    m.position = draw.in_ball(200);
    m.velocity = draw.uniform(5, 15) * draw.direction();
    m.acceleration = factor * draw.uniform(0, 4);
    m.half_space = draw.direction();
    return m;
  };
  std::vector<Motion> motions;
  std::vector<methods::SpaceTimeBound> with, without;
  const auto make = [&](std::size_t i) {
    with[i] = methods::make_bound(motions[i], 0, duration);
    Motion bare = motions[i];
    bare.half_space = {};
    without[i] = methods::make_bound(bare, 0, duration);
  };
  for (std::size_t i = 0; i < 100; ++i) motions.push_back(motion());
  with.resize(motions.size());
  without.resize(motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) make(i);
  methods::IntersectionFinder finder;
  for (;;) {
    const auto& initial = finder.find(without, 0, {.method = methods::IntersectionMethod::sorted}).initial;
    if (initial.empty()) return {with, without};
    for (const methods::BoundContact& pair : initial) {
      motions[pair.b] = motion();
      make(pair.b);
    }
  }
}

void intersections(int trials, std::ofstream& csv) {
  const struct {
    const char* name;
    methods::IntersectionOptions options;
  } all[] = {{"projection", {.method = methods::IntersectionMethod::projection}},
             {"subdivision, n_b = 128", {.method = methods::IntersectionMethod::subdivision, .base_case = 128}},
             {"horns", {.method = methods::IntersectionMethod::sorted, .shape = methods::BoundShape::horn}}};
  std::printf(
      "| bounds for | M up to | method | first intersection without, median s | with | time to know, without over with "
      "|\n|---|---|---|---|---|---|\n");
  methods::IntersectionFinder finder;
  for (const double duration : {1.0, 5.0}) {
    for (const double factor : {1.0, 4.0}) {
      for (const auto& [name, options] : all) {
        std::vector<double> with, without, ratio;
        for (int trial = 0; trial < trials; ++trial) {
          const auto [cut, whole] = bounds_of(duration, factor, static_cast<std::uint64_t>(trial) + 1);
          const Found a = find(finder, cut, duration, options), b = find(finder, whole, duration, options);
          with.push_back(a.earliest);
          without.push_back(b.earliest);
          ratio.push_back(b.seconds / a.seconds);
          csv << name << ',' << duration << ',' << 4 * factor << ',' << trial << ',' << a.earliest << ',' << b.earliest
              << ',' << a.seconds << ',' << b.seconds << '\n';
        }
        std::printf("| %g s | %g | %s | %.3f | %.3f | %.2f |\n", duration, 4 * factor, name, median(without),
                    median(with), median(ratio));
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const int trials = argc > 2 ? std::atoi(argv[2]) : 200;
  std::filesystem::create_directories(folder);
  {
    std::ofstream csv(folder / "sec_4_2_8_bounds.csv");
    csv << "method,seconds,max_acceleration,trial,earliest_with,earliest_without,time_with,time_without\n";
    intersections(trials, csv);
    std::printf("\n");
  }
  std::ofstream csv(folder / "sec_4_2_8.csv");
  csv << "method,trial,planes,motions_asked,detection_seconds,collision\n";
  std::printf(
      "| method (%d trials) | motions asked for, without over with | detection time, without over with | faster with "
      "|\n|---|---|---|---|\n",
      trials);
  std::vector<Plot> plots;
  bool right = true;
  for (const Way& way : ways()) {
    std::vector<double> asked, seconds;
    Series points;
    for (int trial = 0; trial < trials; ++trial) {
      const auto seed = static_cast<std::uint64_t>(trial) + 1;
      const Run with = best_of_three(seed, way.make);
      const Run without =
          best_of_three(seed, [&](MotionSource source) { return way.make(without_planes(std::move(source))); });
      right = right && with.collision == without.collision;
      asked.push_back(static_cast<double>(without.asked) / static_cast<double>(with.asked));
      seconds.push_back(without.detection / with.detection);
      points.x.push_back(with.collision);
      points.y.push_back(seconds.back());
      csv << way.name << ',' << trial << ",yes," << with.asked << ',' << with.detection << ',' << with.collision << '\n'
          << way.name << ',' << trial << ",no," << without.asked << ',' << without.detection << ',' << without.collision
          << '\n';
    }
    const auto faster = std::count_if(seconds.begin(), seconds.end(), [](double s) { return s > 1; });
    std::printf("| %s | %.3f | %.3f | %.0f %% |\n", way.name, median(asked), median(seconds),
                100.0 * static_cast<double>(faster) / static_cast<double>(trials));
    std::fflush(stdout);
    Plot plot;
    plot.title = std::string("4.2.8: ") + way.name;
    plot.x_label = "time of the collision";
    plot.y_label = "time without planes / with";
    plot.log_y = true;
    plot.series = {points};
    plot.levels = {1};
    plots.push_back(plot);
  }
  orchard::plot::write_svg(folder / "sec_4_2_8.svg", plots, 2);
  return right ? 0 : 1;  // planes or not, the same collisions are found
}
