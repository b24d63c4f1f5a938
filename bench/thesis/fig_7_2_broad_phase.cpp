// Figures 7.2 to 7.10: isothetic cubes under forces until two collide or 3 seconds have passed, space-time bounds
// against Turk's spatial hash, and octrees (2.3.2) too:
//   fig_7_2_broad_phase [folder for CSV and SVG] [share of the trials]
// As published: 30, 100 and 300 cubes in 100, 200 and 100 trials, frames of dt_r = 0.02, dt_d = dt_r / 2 for both,
// forces in subsequences with known M and d that start and end at the same times for all, 4th-order Runge-Kutta with
// adaptive steps, every position asked for at each frame, the hash with as much memory as the space-time bounds used,
// the first 42 times as dense as the last. Chosen here, as it is not published: half edges 0.5 to 1.5, speeds 5 to 15,
// M in [0, 4], subsequences of 0.5 s with 5 forces each, balls of radius 38, 107 and 288. Cubes go through the broad
// phase as their bounding spheres; pairs it reports are compared as cubes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "broad_phase_methods/sleeping_broad_phase.h"
#include "cubes.h"
#include "svg_plot.h"

namespace {

using namespace orchard::bench;
using orchard::broad_phase_methods::Rebuild;
using orchard::broad_phase_methods::SleepingMethod;
using orchard::plot::Plot;
using orchard::plot::Series;
using orchard::runtime::BroadPhase;
using orchard::runtime::MotionSource;

struct Setting {
  std::size_t cubes;
  int trials;
  double ball;
  const char *speedup_figure, *worst_figure, *histogram_figure;
};
constexpr Setting kSettings[] = {
    {30, 100, 38.5, "7.2", "7.5", "7.8"}, {100, 200, 107, "7.3", "7.6", "7.9"}, {300, 100, 288, "7.4", "7.7", "7.10"}};

struct Way {
  const char* name;
  MakeBroadPhase make;
  MakeRival rival = {};  // instead
};

Run run(const Way& way, const CubeScene& scene, double end = kEnd, bool stop = true) {
  return way.rival ? run_rival(scene, way.rival, end, stop) : run_bounds(scene, way.make, end, stop);
}

std::vector<Way> ways() {
  const auto sleeping = [](SleepingMethod method, Rebuild rebuild = Rebuild::what_intersected) {
    return [=](MotionSource source) {
      return orchard::broad_phase_methods::make_sleeping_broad_phase(std::move(source),
                                                                     {method, rebuild, {.time_step = kDetection}});
    };
  };
  return {{"projection", sleeping(SleepingMethod::projection)},
          {"projection with everything rebuilt", sleeping(SleepingMethod::projection, Rebuild::everything)},
          {"subdivision", sleeping(SleepingMethod::subdivision)},
          {"hybrid", sleeping(SleepingMethod::hybrid)},
          {"quadratic faces", sleeping(SleepingMethod::quadratic)},
          {"horns", sleeping(SleepingMethod::horns)},
          {"octree, rebuilt at each step", {}, octree_of(MovingOctree::Upkeep::rebuilt)},
          {"octree, updated", {}, octree_of(MovingOctree::Upkeep::updated)},
          {"events", [](MotionSource source) { return BroadPhase(std::move(source), {.time_step = kDetection}); }}};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Run best_of(const std::function<Run()>& make) {
  Run best = make();
  for (int round = 0; round < 2; ++round) {
    const Run again = make();
    best.overall = std::min(best.overall, again.overall);
    best.detection = std::min(best.detection, again.detection);
    for (std::size_t i = 0; i < best.frames.size(); ++i) best.frames[i] = std::min(best.frames[i], again.frames[i]);
  }
  return best;
}

Series histogram(const std::string& name, const std::vector<double>& frames, double width) {
  Series bars{name, {}, {}, Series::Kind::bars};
  for (int i = 0; i < 40; ++i) {
    bars.x.push_back(1e6 * i * width);
    bars.y.push_back(0);
  }
  for (const double f : frames) bars.y[std::min<std::size_t>(39, static_cast<std::size_t>(f / width))] += 1;
  return bars;
}

// What the trials of a setting came to: the speedups of each way, and the detection times of all frames.
struct Outcome {
  explicit Outcome(std::size_t ways) : overall(ways), detection(ways), worst(ways) {}
  std::vector<Series> overall, detection, worst;
  std::vector<double> hash_frames, projection_frames, event_frames;
};

// False if a way found another collision than the hash.
bool run_trial(const Setting& setting, int trial, double cell, Outcome& outcome, std::ofstream& csv) {
  const std::vector<Way> all = ways();
  const auto seed = static_cast<std::uint64_t>(trial) + 1;
  std::size_t memory = 0;
  std::vector<Run> runs;
  for (const Way& way : all) {
    runs.push_back(best_of([&] { return run(way, {setting.cubes, setting.ball, seed}); }));
    if (memory == 0) memory = runs.back().memory;  // projection's
  }
  const Run hash = best_of([&] { return run_rival({setting.cubes, setting.ball, seed}, hash_of(memory, cell)); });
  const auto append = [](std::vector<double>& to, const Run& run) {
    to.insert(to.end(), run.frames.begin(), run.frames.end());
  };
  append(outcome.hash_frames, hash);
  append(outcome.projection_frames, runs.front());
  append(outcome.event_frames, runs.back());
  bool right = true;
  for (std::size_t w = 0; w < all.size(); ++w) {
    if (std::fabs(runs[w].collision - hash.collision) > 1e-9) {
      std::printf("%s: another collision in trial %d: %g, not %g\n", all[w].name, trial, runs[w].collision,
                  hash.collision);
      right = false;
    }
    const auto add = [&](Series& series, double ours, double theirs) {
      series.x.push_back(hash.collision);
      series.y.push_back(theirs / ours);
    };
    add(outcome.overall[w], runs[w].overall, hash.overall);
    add(outcome.detection[w], runs[w].detection, hash.detection);
    add(outcome.worst[w], runs[w].worst(), hash.worst());
    csv << setting.cubes << ',' << trial << ',' << all[w].name << ',' << hash.collision << ',' << runs[w].overall << ','
        << runs[w].detection << ',' << runs[w].worst() << ',' << hash.overall << ',' << hash.detection << ','
        << hash.worst() << ',' << runs[w].memory << ',' << hash.memory << '\n';
  }
  return right;
}

void print_medians(const Setting& setting, const Outcome& outcome) {
  const std::vector<Way> all = ways();
  for (std::size_t w = 0; w < all.size(); ++w) {
    const std::vector<double>& detection = outcome.detection[w].y;
    const auto faster = std::count_if(detection.begin(), detection.end(), [](double s) { return s > 1; });
    std::printf("| %zu | %s | %.2f | %.2f | %.2f | %.0f %% |\n", setting.cubes, all[w].name,
                median(outcome.overall[w].y), median(detection), median(outcome.worst[w].y),
                100.0 * static_cast<double>(faster) / static_cast<double>(detection.size()));
  }
  std::fflush(stdout);
}

// Of the first way and the last.
Plot scatter(const std::string& title, const std::vector<Series>& speedups) {
  Plot plot{.title = title,
            .x_label = "time of the collision",
            .y_label = "speedup over the spatial hash",
            .log_y = true,
            .series = {speedups.front(), speedups.back()},
            .levels = {1},
            .x_names = {}};
  plot.series.front().name = ways().front().name;
  plot.series.back().name = ways().back().name;
  return plot;
}

void draw(const Setting& setting, const Outcome& outcome, const std::filesystem::path& folder) {
  const std::string cubes = ", " + std::to_string(setting.cubes) + " cubes";
  std::vector<double> sorted = outcome.hash_frames;
  std::sort(sorted.begin(), sorted.end());
  const double width = 2 * sorted[sorted.size() * 99 / 100] / 40;
  Plot frames{.title = std::string("Fig. ") + setting.histogram_figure + ": frames" + cubes,
              .x_label = "detection time of a frame, microseconds",
              .y_label = "frames + 1",
              .log_y = true,
              .series = {histogram("spatial hash", outcome.hash_frames, width),
                         histogram("projection", outcome.projection_frames, width),
                         histogram("events", outcome.event_frames, width)},
              .levels = {},
              .x_names = {}};
  for (Series& bars : frames.series) {
    for (double& count : bars.y) count += 1;
  }
  const std::string speedup = std::string("Fig. ") + setting.speedup_figure;
  orchard::plot::write_svg(
      folder / ("fig_" + std::string(setting.speedup_figure) + ".svg"),
      {scatter(speedup + ": overall" + cubes, outcome.overall),
       scatter(speedup + ": detection only" + cubes, outcome.detection),
       scatter(std::string("Fig. ") + setting.worst_figure + ": worst frame" + cubes, outcome.worst), frames},
      2);
}

bool run_setting(const Setting& setting, double share, const std::filesystem::path& folder, std::ofstream& csv) {
  const double cell = best_cell({setting.cubes, setting.ball, 1});
  const int trials = std::max(1, static_cast<int>(setting.trials * share));
  Outcome outcome(ways().size());
  bool right = true;
  for (int trial = 0; trial < trials; ++trial) right = run_trial(setting, trial, cell, outcome, csv) && right;
  print_medians(setting, outcome);
  draw(setting, outcome, folder);
  return right;
}

// The same motion with more cubes at the 300 cubes' density, through collisions: detection only, per frame.
void run_large(std::ofstream& csv) {
  std::printf(
      "\n| cubes | hash, ms a frame | events | projection | hybrid | quadratic faces | horns "
      "| octree, rebuilt | octree, updated |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::size_t count : {1000u, 10000u, 100000u}) {
    const double ball = 288 * std::cbrt(static_cast<double>(count) / 300);
    const double end = count > 10000 ? 0.1 : count > 1000 ? 0.5 : 1;
    const double frames = end / kFrame + 1;
    const double cell = best_cell({count, ball, 1});
    const Run hash = run_rival({count, ball, 1}, hash_of(0, cell), end, false);
    std::printf("| %zu | %.3f ", count, 1e3 * hash.detection / frames);
    const std::vector<Way> all = ways();
    for (const std::size_t w : {8u, 0u, 3u, 4u, 5u, 6u, 7u}) {
      const Run own = run(all[w], {count, ball, 1}, w == 8 ? kEnd : end, false);
      const double per_frame = own.detection / static_cast<double>(own.frames.size());
      std::printf("| %.3f: %.2f times ", 1e3 * per_frame, hash.detection / frames / per_frame);
      std::fflush(stdout);
      csv << count << ",large," << all[w].name << ",,," << per_frame << ",,," << hash.detection / frames << ",,,\n";
    }
    std::printf("|\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const double share = argc > 2 ? std::atof(argv[2]) : 1;
  std::filesystem::create_directories(folder);
  std::ofstream csv(folder / "fig_7_2.csv");
  csv << "cubes,trial,method,collision,overall,detection,worst,hash_overall,hash_detection,hash_worst,memory,hash_"
         "memory\n";
  std::printf(
      "| cubes | method | overall speedup | detection only | worst frame | faster than the hash "
      "|\n|---|---|---|---|---|---|\n");
  bool right = true;
  for (const Setting& setting : kSettings) right = run_setting(setting, share, folder, csv) && right;
  run_large(csv);
  return right ? 0 : 1;
}
