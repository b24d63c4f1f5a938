// Section 4.2.5: the time to find the earliest intersection of hypertrapezoids, by projection and by subdivision, and
// by the methods of section 8.2:  fig_4_16_face_intersections [folder for CSV and SVG] [trials] [figures|all] 200
// trials; r in [0.5, 1.5], positions in a ball of radius 200, speeds 5 to 15, M in [0, 4]. Aligned with an axis:
// positions within 0.1 of the plane across it, velocities along it; aligned with a plane: positions within 0.1 of the
// axis across it, velocities in the plane; with M = 0 as well. `figures` are those that the text draws, N = 100, and
// then more bodies than it had, at the same density; `all` are also those that it omits as alike: N = 50 and 200, half
// and double density, the other axes and planes. All apart at the start. Chosen here, as it is not published: the n_b
// tried, and that bounds hold for 5 seconds, so that most trials have an intersection.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "broad_phase_methods/space_time_bound.h"
#include "svg_plot.h"
#include "worlds.h"

namespace {

using namespace orchard::broad_phase_methods;
namespace test = orchard::runtime::test;
using orchard::plot::Plot;
using orchard::plot::Series;

constexpr double kDuration = 5;
constexpr std::uint32_t kBaseCases[] = {4, 8, 16, 32, 64, 128};

// Of velocities: anywhere, along an axis, or in the plane across it.
enum class Alignment { none, axis, plane };

struct Test {
  std::string name;
  std::string figure;  // or what the text calls alike to it
  Alignment alignment = Alignment::none;
  std::size_t axis = 0;
  bool accelerated = true;
  std::size_t count = 100;
  double density = 1;
};

std::vector<Test> tests_of(const std::string& which) {
  std::vector<Test> tests{{"random", "4.16"},
                          {"aligned with the x axis", "4.17", Alignment::axis, 0},
                          {"aligned with the x-y plane", "4.18", Alignment::plane, 2},
                          {"aligned with the x axis, M = 0", "4.19", Alignment::axis, 0, false},
                          {"aligned with the x-y plane, M = 0", "4.20", Alignment::plane, 2, false}};
  if (which == "figures") return tests;
  const Test more[] = {{"random, N = 50", "as 4.16", Alignment::none, 0, true, 50},
                       {"random, N = 200", "as 4.16", Alignment::none, 0, true, 200},
                       {"random, half density", "as 4.16", Alignment::none, 0, true, 100, 0.5},
                       {"random, double density", "as 4.16", Alignment::none, 0, true, 100, 2},
                       {"aligned with the y axis", "as 4.17", Alignment::axis, 1},
                       {"aligned with the z axis", "as 4.17", Alignment::axis, 2},
                       {"aligned with the x-z plane", "above 4.18", Alignment::plane, 1},
                       {"aligned with the y-z plane", "above 4.18", Alignment::plane, 0}};
  tests.insert(tests.end(), std::begin(more), std::end(more));
  return tests;
}

struct Way {
  const char* name;
  IntersectionOptions options;
};

std::vector<Way> ways() {
  std::vector<Way> result = {{"projection", {.method = IntersectionMethod::projection}}};
  for (const std::uint32_t n : kBaseCases) {
    result.push_back({"subdivision", {.method = IntersectionMethod::subdivision, .base_case = n}});
  }
  result.push_back({"hybrid", {.method = IntersectionMethod::hybrid, .base_case = 32}});
  result.push_back({"quadratic faces", {.method = IntersectionMethod::projection, .shape = BoundShape::quadratic}});
  result.push_back({"horns", {.method = IntersectionMethod::sorted, .shape = BoundShape::horn}});
  result.push_back({"all pairs", {.method = IntersectionMethod::all_pairs}});
  return result;
}

Motion draw_motion(const Test& test, double ball, test::Draw& draw) {
  Motion m;
  m.radius = draw.uniform(0.5, 1.5);
  m.position = draw.in_ball(ball);
  const double speed = draw.uniform(5, 15);
  m.velocity = speed * draw.direction();
  m.acceleration = test.accelerated ? draw.uniform(0, 4) : 0;
  if (test.alignment == Alignment::axis) {
    m.position[test.axis] = draw.uniform(-0.1, 0.1);
    m.velocity = {};
    m.velocity[test.axis] = draw.uniform(0, 1) < 0.5 ? speed : -speed;
  } else if (test.alignment == Alignment::plane) {
    for (std::size_t k = 0; k < 3; ++k)
      m.position[k] = k == test.axis ? draw.uniform(-ball, ball) : draw.uniform(-0.1, 0.1);
    const double angle = draw.uniform(0, 6.283185307179586);
    m.velocity = {};
    m.velocity[(test.axis + 1) % 3] = speed * std::cos(angle);
    m.velocity[(test.axis + 2) % 3] = speed * std::sin(angle);
  }
  return m;
}

// Apart at time 0: those that overlap are drawn again.
std::vector<SpaceTimeBound> bounds_of(const Test& test, std::uint64_t seed) {
  test::Draw draw(seed);
  const std::size_t count = test.count;
  const double ball = 200 * std::cbrt(static_cast<double>(count) / (100 * test.density));
  std::vector<SpaceTimeBound> bounds;
  for (std::size_t i = 0; i < count; ++i) bounds.push_back(make_bound(draw_motion(test, ball, draw), 0, kDuration));
  IntersectionFinder finder;
  for (;;) {
    const auto& initial = finder.find(bounds, 0, {.method = IntersectionMethod::sorted}).initial;
    if (initial.empty()) return bounds;
    for (const BoundContact& pair : initial) bounds[pair.b] = make_bound(draw_motion(test, ball, draw), 0, kDuration);
  }
}

struct Timing {
  double seconds, contact;
};

Timing time(IntersectionFinder& finder, const std::vector<SpaceTimeBound>& bounds, const IntersectionOptions& options,
            int rounds) {
  Timing result{1e300, kNoContact};
  for (int round = 0; round < rounds; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    result.contact = finder.find(bounds, kDuration, options).earliest.time;
    result.seconds =
        std::min(result.seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return result;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

// One figure: a row of the table, and a plot per n_b, or one over n_b where nothing ever meets.
std::vector<Plot> run(const Test& test, int trials, std::ofstream& csv) {
  const std::vector<Way> all = ways();
  std::vector<std::vector<double>> seconds(all.size());
  std::vector<double> contacts;
  IntersectionFinder finder;
  for (int trial = 0; trial < trials; ++trial) {
    const auto bounds = bounds_of(test, static_cast<std::uint64_t>(trial) + 1);
    for (std::size_t w = 0; w < all.size(); ++w) {
      const Timing timing = time(finder, bounds, all[w].options, 3);
      seconds[w].push_back(timing.seconds);
      if (w == 0) contacts.push_back(timing.contact);
      csv << test.figure << ',' << '"' << test.name << '"' << ',' << trial << ',' << all[w].name << ','
          << all[w].options.base_case << ',' << timing.seconds << ',' << timing.contact << '\n';
    }
  }
  std::printf("| %s | %s ", test.figure.c_str(), test.name.c_str());
  for (const auto& s : seconds) std::printf("| %.0f ", 1e6 * median(s));
  std::printf("|\n");
  std::fflush(stdout);

  std::vector<Plot> plots;
  Series over_base_case;
  for (std::size_t k = 0; k < std::size(kBaseCases); ++k) {
    Plot plot{.title = "Fig. " + test.figure + ", n_b = " + std::to_string(kBaseCases[k]),
              .x_label = "time of the earliest intersection",
              .y_label = "speedup of projection",
              .log_y = true,
              .series = {},
              .levels = {1},
              .x_names = {}};
    Series points;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const double speedup = seconds[1 + k][i] / seconds[0][i];
      points.x.push_back(contacts[i]);
      points.y.push_back(speedup);
      over_base_case.x.push_back(kBaseCases[k]);
      over_base_case.y.push_back(speedup);
    }
    plot.series = {points};
    plots.push_back(plot);
  }
  if (test.accelerated) return plots;
  return {Plot{.title = "Fig. " + test.figure + ": " + test.name,
               .x_label = "n_b",
               .y_label = "speedup of projection",
               .log_x = true,
               .log_y = true,
               .series = {over_base_case},
               .levels = {1},
               .x_names = {}}};
}

// The random test with more bodies, at the same density.
void run_large(std::ofstream& csv) {
  std::printf(
      "\n| bodies | projection, ms | subdivision, n_b = 128 | hybrid | quadratic faces | horns "
      "|\n|---|---|---|---|---|---|\n");
  const IntersectionOptions options[] = {{.method = IntersectionMethod::projection},
                                         {.method = IntersectionMethod::subdivision, .base_case = 128},
                                         {.method = IntersectionMethod::hybrid, .base_case = 32},
                                         {.method = IntersectionMethod::projection, .shape = BoundShape::quadratic},
                                         {.method = IntersectionMethod::sorted, .shape = BoundShape::horn}};
  IntersectionFinder finder;
  for (const std::size_t count : {1000u, 10000u, 100000u}) {
    Test test{"random", "4.16"};
    test.count = count;
    const auto bounds = bounds_of(test, 1);
    std::printf("| %zu ", count);
    for (const IntersectionOptions& o : options) {
      const Timing timing = time(finder, bounds, o, count > 10000 ? 1 : 3);
      std::printf("| %.2f ", 1e3 * timing.seconds);
      std::fflush(stdout);
      csv << "large,random," << count << ',' << static_cast<int>(o.method) << ',' << o.base_case << ','
          << timing.seconds << ',' << timing.contact << '\n';
    }
    std::printf("|\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const int trials = argc > 2 ? std::atoi(argv[2]) : 200;
  const std::string which = argc > 3 ? argv[3] : "figures";
  std::filesystem::create_directories(folder);
  std::ofstream csv(folder / "fig_4_16.csv");
  csv << "figure,test,trial,method,base_case,seconds,earliest\n";
  std::printf("| figure | test (%d trials, median microseconds) ", trials);
  for (const Way& way : ways()) {
    std::printf("| %s", way.name);
    std::printf(way.options.method == IntersectionMethod::subdivision ? ", n_b = %u " : " ", way.options.base_case);
  }
  std::printf("|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<Plot> flat;
  for (const Test& test : tests_of(which)) {
    const std::vector<Plot> plots = run(test, trials, csv);
    if (plots.size() == 1) {
      flat.push_back(plots[0]);
    } else if (test.figure.starts_with("4.")) {
      orchard::plot::write_svg(folder / ("fig_" + test.figure + ".svg"), plots, 3);
    }
  }
  orchard::plot::write_svg(folder / "fig_4.19_4.20.svg", flat, 2);
  if (which == "figures") run_large(csv);
  return 0;
}
