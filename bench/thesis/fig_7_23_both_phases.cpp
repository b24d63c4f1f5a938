// Figures 7.23 to 7.25: both phases together. The flight simulator (one steered ship, 10 drones, t = 0 to 40, frames of
// 0.1, dt_d = 0.05) by Turk's hash and BSP-trees, and by events and sphere-trees; then, where the text expects graceful
// degradation to show best, a falling pile whose bodies stay in touch, and many more bodies:
//   fig_7_23_both_phases FOLDER TREE.orchard [asteroids, default 10000]
// The same motion for both ways: bodies move by the exact answers. Degradation is by counted work, so that it repeats:
// a frame's budget is a half, a quarter and an eighth of what exact answers take in the busiest frames (the 99th
// percentile), without what the step before found. Frames are not drawn here, so the other time is that of the
// dynamics alone. All times are the processor's for this thread, so that nothing else that the machine does is in them.
// One experiment with many tables, hence more than 300 lines.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "bodies.h"
#include "simulation.h"
#include "svg_plot.h"
#include "turk_hash.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;
using namespace orchard::simulation;
using orchard::plot::Plot;
using orchard::plot::Series;

// Of the processor's time for this thread: 0.3 microseconds to ask for.
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

double microseconds_since(double begin) { return now() - begin; }

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

struct Times {
  std::vector<double> hash, ours;    // detection, microseconds a frame
  std::vector<double> other, slack;  // what else a frame took with ours, and what was left of it
  std::uint64_t pairs = 0, touching = 0, differ = 0;
};

// The hash and the BSP-trees see the bodies where the others do, at every step.
class Rivals {
 public:
  Rivals(const PackedSphereTree& tree, bool exact) : bsp_(exact ? bsp_trees(tree, tree) : nullptr) {}

  double detect(const World& world, const StepOutcome& ours, Times& times) {
    positions_.clear();
    radii_.clear();
    bodies_.clear();
    for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
      if (!world.bodies[i].there) continue;
      positions_.push_back(world.bodies[i].position);
      radii_.push_back(world.bodies[i].radius);
      bodies_.push_back(i);
    }
    if (!hash_) hash_ = std::make_unique<TurkHash>(positions_, radii_);
    const auto begin = now();
    const auto& pairs = hash_->find(positions_, radii_);
    double spent = microseconds_since(begin);
    if (!bsp_) return spent;
    std::vector<Query> queries;
    for (const auto& [a, b] : pairs) {
      const auto pose = [&](std::uint32_t k) { return pose_of(world.bodies[bodies_[k]], world.shapes[0]); };
      queries.push_back({pose(std::min(a, b)), pose(std::max(a, b)), 0});
    }
    bsp_->place(queries);
    const auto middle = now();
    std::size_t touching = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) touching += bsp_->collide(i);
    spent += microseconds_since(middle);
    times.differ += static_cast<std::uint64_t>(
        std::abs(static_cast<std::int64_t>(touching) - static_cast<std::int64_t>(ours.pairs.size())));
    return spent;
  }

 private:
  std::unique_ptr<PairRival> bsp_;
  std::unique_ptr<TurkHash> hash_;
  std::vector<Vec3> positions_;
  std::vector<double> radii_;
  std::vector<std::uint32_t> bodies_;
};

Times run(const char* scene, std::size_t bodies, int frames, const PackedSphereTree& tree, bool exact) {
  const auto world = make_world(scene, {shape_of(tree)}, bodies, 1);
  Draw draw(1001);
  Rivals rivals(tree, exact);
  Times times;
  const int steps = static_cast<int>(std::lround(world->scene.frame / world->scene.step));
  for (int frame = 0; frame < frames; ++frame) {
    if (frame % 20 == 0) world->steering = {draw.uniform(0, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    double hash = 0, ours = 0, other = 0;
    for (int step = 0; step < steps; ++step) {
      auto begin = now();
      world->time = (frame * steps + step) * world->scene.step;
      world->scene.before(*world, world->time);
      other += microseconds_since(begin);
      begin = now();
      const StepOutcome outcome = world->detection.step(world->time, {});
      ours += microseconds_since(begin);
      hash += rivals.detect(*world, outcome, times);
      times.pairs += outcome.overlapping;
      times.touching += outcome.pairs.size();
      begin = now();
      respond_and_move(*world, outcome);
      other += microseconds_since(begin);
    }
    times.hash.push_back(hash);
    times.ours.push_back(ours);
    times.other.push_back(other);
  }
  return times;
}

void print_times(const char* scene, const char* way, const std::vector<double>& times) {
  std::printf("| %s | %s | %.1f | %.1f | %.1f | %.1f |\n", scene, way, percentile(times, 0.5), percentile(times, 0.99),
              percentile(times, 0.999), percentile(times, 1));
}

void write_frames(const std::filesystem::path& file, const Times& times) {
  std::ofstream csv(file);
  csv << "frame,turk_us,events_and_sphere_trees_us,other_us,slack_us\n";
  for (std::size_t i = 0; i < times.ours.size(); ++i)
    csv << i << ',' << times.hash[i] << ',' << times.ours[i] << ',' << times.other[i] << ',' << times.slack[i] << '\n';
}

Plot traces(const std::string& title, const Times& times) {
  Plot plot;
  plot.title = title;
  plot.x_label = "frame";
  plot.y_label = "microseconds";
  plot.log_y = true;
  const auto add = [&](const char* name, const std::vector<double>& values) {
    Series line{name, {}, {}, Series::Kind::line};
    for (std::size_t i = 0; i < values.size(); ++i) {
      line.x.push_back(static_cast<double>(i));
      line.y.push_back(values[i]);
    }
    plot.series.push_back(line);
  };
  add("Turk's hash and BSP-trees", times.hash);
  add("events and sphere-trees", times.ours);
  add("other", times.other);
  add("slack", times.slack);
  return plot;
}

// What a scene did within a budget; what is left open counts as a collision.
struct Degraded {
  std::vector<double> work, bounds;  // of frames; the bound: of those with anything open
  std::vector<std::size_t> stopped;  // by level
  std::size_t pairs = 0, open = 0, left_over = 0;
};

Degraded within(const Budget& budget, const char* scene, std::size_t bodies, int frames, const PackedSphereTree& tree) {
  Simulation simulation(scene, {shape_of(tree)}, bodies, 1);
  Draw draw(1001);
  Steering steering;
  Degraded all;
  all.stopped.resize(tree.depth + 1, 0);
  for (int frame = 0; frame < frames; ++frame) {
    if (frame % 20 == 0) steering = {draw.uniform(0, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    const FrameRecord record = simulation.frame(budget, steering);
    all.pairs += record.pairs;
    all.open += record.maybe;
    all.left_over += record.left_over;
    all.work.push_back(static_cast<double>(record.work));
    if (record.maybe > 0) all.bounds.push_back(record.worst_bound / shape_of(tree).radius);
    for (std::size_t level = 0; level < kLevels; ++level)
      all.stopped[std::min<std::size_t>(level, tree.depth)] += record.stopped[level];
  }
  return all;
}

// Of the busiest frames, by a budget that never ends: what exact answers take without what the step before found.
double max_work(const char* scene, std::size_t bodies, int frames, const PackedSphereTree& tree) {
  return percentile(within({.work = std::uint64_t{1} << 40}, scene, bodies, frames, tree).work, 0.99);
}

// Fig. 7.25: where a budget ended.
Plot degrade(const char* scene, std::size_t bodies, int frames, const PackedSphereTree& tree, std::ofstream& csv) {
  Plot plot;
  plot.title = std::string("Fig. 7.25: ") + scene;
  plot.x_label = "level where the budget ended";
  plot.y_label = "pairs left open";
  const double most = max_work(scene, bodies, frames, tree);
  for (const int part : {2, 4, 8}) {
    const auto budget = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(most / part));
    const Degraded all = within({.work = budget}, scene, bodies, frames, tree);
    const std::vector<std::size_t>& stopped = all.stopped;
    std::printf("| %s | 1/%d | %zu | %.1f %% ", scene, part, all.pairs,
                all.pairs > 0 ? 100.0 * static_cast<double>(all.open) / static_cast<double>(all.pairs) : 0.0);
    Series bars{"1/" + std::to_string(part), {}, {}, Series::Kind::line};
    std::printf("| ");
    for (std::size_t level = 0; level < stopped.size(); ++level) {
      std::printf("%zu ", stopped[level]);
      if (level >= plot.x_names.size()) plot.x_names.push_back(std::to_string(level));
      bars.x.push_back(static_cast<double>(level));
      bars.y.push_back(static_cast<double>(stopped[level]));
      csv << scene << ",1/" << part << ',' << level << ',' << stopped[level] << '\n';
    }
    std::printf("| %zu | %.3f | %llu | %.0f | %.0f |\n", all.left_over, percentile(all.bounds, 0.5),
                static_cast<unsigned long long>(budget), percentile(all.work, 0.5), percentile(all.work, 1));
    plot.series.push_back(bars);
  }
  return plot;
}

// Detection's times, frame by frame, within a budget in time; and how many pairs it leaves open.
struct Kept {
  std::vector<double> microseconds;
  std::uint64_t pairs = 0, open = 0;
};
Kept keep(double budget, const char* scene, std::size_t bodies, int frames, const PackedSphereTree& tree) {
  const auto world = make_world(scene, {shape_of(tree)}, bodies, 1);
  Draw draw(1001);
  Kept kept;
  const int steps = static_cast<int>(std::lround(world->scene.frame / world->scene.step));
  const auto time = std::chrono::nanoseconds(static_cast<std::int64_t>(1e3 * budget / steps));
  for (int frame = 0; frame < frames; ++frame) {
    if (frame % 20 == 0) world->steering = {draw.uniform(0, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    double spent = 0;
    for (int step = 0; step < steps; ++step) {
      world->time = (frame * steps + step) * world->scene.step;
      world->scene.before(*world, world->time);
      const double begin = now();
      const StepOutcome outcome = world->detection.step(world->time, {.time = time});
      spent += microseconds_since(begin);
      kept.pairs += outcome.overlapping;
      for (const PairOutcome& pair : outcome.pairs) kept.open += pair.verdict.answer == Answer::maybe;
      respond_and_move(*world, outcome);
    }
    kept.microseconds.push_back(spent);
  }
  return kept;
}

// Whether budgets in time hold: a half and an eighth of what the slowest frame's exact answers take.
void keep_time(const char* scene, std::size_t bodies, int frames, const PackedSphereTree& tree, const Times& exact) {
  for (const int part : {2, 8}) {
    const double budget = percentile(exact.ours, 1) / part;
    const Kept all = keep(budget, scene, bodies, frames, tree);
    const auto late = std::count_if(all.microseconds.begin(), all.microseconds.end(),
                                    [&](double microseconds) { return microseconds > budget; });
    std::printf("| %s | 1/%d | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f %% | %.1f %% |\n", scene, part, budget,
                percentile(all.microseconds, 0.5), percentile(all.microseconds, 0.99),
                percentile(all.microseconds, 0.999), percentile(all.microseconds, 1),
                100.0 * static_cast<double>(late) / frames,
                all.pairs > 0 ? 100.0 * static_cast<double>(all.open) / static_cast<double>(all.pairs) : 0.0);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: fig_7_23_both_phases FOLDER TREE.orchard [asteroids]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const PackedSphereTree tree = read_body(argv[2]);
  const std::size_t many = argc > 3 ? static_cast<std::size_t>(std::atol(argv[3])) : 10000;
  struct Setting {
    const char* scene;
    std::size_t bodies;
    int frames;
    double frame_budget;  // microseconds of a frame that runs as fast as what it shows
  };
  const Setting settings[] = {{"flight", 10, 400, 1e5}, {"pile", 24, 400, 2e4}, {"asteroids", many, 50, 2e4}};
  std::vector<Times> all;
  std::printf("| scene | detection, microseconds a frame | p50 | p99 | p99.9 | max |\n|---|---|---|---|---|---|\n");
  std::vector<Plot> plots;
  bool right = true;
  for (const Setting& s : settings) {
    all.push_back(run(s.scene, s.bodies, s.frames, tree, true));
    Times& times = all.back();
    print_times(s.scene, "Turk's hash and BSP-trees", times.hash);
    print_times(s.scene, "events and sphere-trees", times.ours);
    std::vector<double> ratio;
    for (std::size_t i = 0; i < times.ours.size(); ++i) {
      ratio.push_back(times.hash[i] / times.ours[i]);
      times.slack.push_back(s.frame_budget - times.ours[i] - times.other[i]);
    }
    print_times(s.scene, "speedup", ratio);
    print_times(s.scene, "other", times.other);
    print_times(s.scene, "slack", times.slack);
    write_frames(folder / (std::string("fig_7_23_") + s.scene + ".csv"), times);
    plots.push_back(traces(std::string("Figs. 7.23, 7.24: ") + s.scene, times));
    right = right && times.differ * 1000 <= times.pairs;
  }
  std::printf("\n| scene | pairs | touching | answers that differ |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < all.size(); ++i)
    std::printf("| %s | %llu | %llu | %llu |\n", settings[i].scene, static_cast<unsigned long long>(all[i].pairs),
                static_cast<unsigned long long>(all[i].touching), static_cast<unsigned long long>(all[i].differ));
  std::printf(
      "\n| scene | budget, of the busiest frames' work | pairs | left open | by level 0, 1, .. | not looked at | worst "
      "bound of a "
      "frame / R, median | budget | work of a frame, p50 | max |\n|---|---|---|---|---|---|---|---|---|---|\n");
  std::ofstream csv(folder / "fig_7_25.csv");
  csv << "scene,budget,level,left_open\n";
  std::vector<Plot> levels;
  for (std::size_t i = 0; i < all.size(); ++i)
    levels.push_back(degrade(settings[i].scene, settings[i].bodies, settings[i].frames, tree, csv));
  std::printf(
      "\n| scene | budget in time, of the slowest frame | microseconds | a frame's detection, p50 | p99 | p99.9 | max "
      "| "
      "late | left open |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < all.size(); ++i)
    keep_time(settings[i].scene, settings[i].bodies, settings[i].frames, tree, all[i]);
  orchard::plot::write_svg(folder / "fig_7.23.svg", plots, 3);
  orchard::plot::write_svg(folder / "fig_7.25.svg", levels, 3);
  return right ? 0 : 1;
}
