// Figures 4.14 and 4.15: the worst cases of the projection method and of the subdivision method, and how their work
// grows with the number of hypertrapezoids:  fig_4_14_worst_cases [folder for CSV and SVG] [largest number]
// In each scene no two bodies ever meet, so that no search may end early.
//   spiral: bodies above each other along y, whose lines in the plane of x and t all cross (Fig. 4.14)
//   bundle: bodies that move side by side along the diagonal of space and time (Fig. 4.15)
//   random: the random pattern of 4.2.5 with the same M = 0 for all, of those pairs that never meet
// Counts are the same on every machine; times are the best of three.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "broad_phase_methods/space_time_bound.h"
#include "svg_plot.h"
#include "worlds.h"

namespace {

using namespace orchard::broad_phase_methods;
namespace test = orchard::runtime::test;
using orchard::plot::Plot;
using orchard::plot::Series;

constexpr double kTooLong = 0.3;           // seconds, after which a method is not tried with more bodies
constexpr double kRadius = 0.4, kGap = 1;  // of bodies, and between their lines

using Bounds = std::vector<SpaceTimeBound>;

SpaceTimeBound bound_of(const Vec3& position, const Vec3& velocity) {
  Motion motion;
  motion.position = position;
  motion.velocity = velocity;
  motion.radius = kRadius;
  return make_bound(motion, 0, 1);
}

// The order along x at the end is the reverse of that at the start. Ends are moved a little at random, or all lines
// would cross in one point.
Bounds spiral(std::size_t count) {
  test::Draw draw(count);
  Bounds bounds;
  for (std::size_t i = 0; i < count; ++i) {
    const double start = 2 * kGap * static_cast<double>(i), end = -start + draw.uniform(0, 0.5 * kGap);
    bounds.push_back(bound_of({start, 2 * kGap * static_cast<double>(i), 0}, {end - start, 0, 0}));
  }
  return bounds;
}

Bounds bundle(std::size_t count) {
  Bounds bounds;
  const double way = kGap * static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = kGap * static_cast<double>(i);
    bounds.push_back(bound_of({x, x, x}, {way, way, way}));
  }
  return bounds;
}

// At the density of 4.2.5; what would meet another one is drawn again.
Bounds random(std::size_t count) {
  test::Draw draw(count);
  const double ball = 200 * std::cbrt(static_cast<double>(count) / 100);
  const auto drawn = [&] { return bound_of(draw.in_ball(ball), draw.uniform(5, 15) * draw.direction()); };
  Bounds bounds;
  while (bounds.size() < count) {
    const SpaceTimeBound next = drawn();
    const bool apart = std::none_of(bounds.begin(), bounds.end(), [&](const SpaceTimeBound& other) {
      return first_contact(next, other, 1, BoundShape::hypertrapezoid) <= 1;
    });
    if (apart) bounds.push_back(next);
  }
  return bounds;
}

struct Scene {
  const char *name, *title;
  Bounds (*make)(std::size_t);
};
constexpr Scene kScenes[] = {{"spiral", "Fig. 4.14: worst for projection", spiral},
                             {"bundle", "Fig. 4.15: worst for subdivision", bundle},
                             {"random", "random, M = 0", random}};

struct Way {
  const char* name;
  IntersectionOptions options;
};
constexpr Way kWays[] = {{"projection", {.method = IntersectionMethod::projection}},
                         {"subdivision, n_b = 4", {.method = IntersectionMethod::subdivision, .base_case = 4}},
                         {"subdivision, n_b = 32", {.method = IntersectionMethod::subdivision, .base_case = 32}},
                         {"hybrid", {.method = IntersectionMethod::hybrid, .base_case = 32}},
                         {"horns, sorted", {.method = IntersectionMethod::sorted, .shape = BoundShape::horn}},
                         {"all pairs", {.method = IntersectionMethod::all_pairs}}};

struct Row {
  std::size_t count;
  double seconds;
  SearchCounts counts;
};

// Ends the program if a search finds a contact where there is none.
Row measure(const Bounds& bounds, const IntersectionOptions& options) {
  Row row{bounds.size(), 1e300, {}};
  IntersectionFinder finder;
  for (int round = 0; round < 3; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    const Intersections& found = finder.find(bounds, 1, options);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    row.seconds = std::min(row.seconds, taken.count());
    row.counts = found.counts;
    if (found.earliest.time == kNoContact) continue;
    std::printf("a contact at %g of %zu bodies that never meet\n", found.earliest.time, bounds.size());
    std::exit(1);
  }
  return row;
}

// The exponent by which the time grows, between the last row and that of a quarter as many bodies.
double exponent(const std::vector<Row>& rows) {
  const Row &few = rows[rows.size() - 3], &many = rows.back();
  return std::log(many.seconds / few.seconds) /
         std::log(static_cast<double>(many.count) / static_cast<double>(few.count));
}

void print_counts(const Scene& scene, const std::vector<std::vector<Row>>& ways) {
  for (std::size_t i = 0; i < ways[1].size(); ++i) {
    const std::size_t n = ways[0][i].count;
    const SearchCounts &swept = ways[0][i].counts, &fine = ways[1][i].counts;
    std::printf("| %s | %zu | %zu | %zu | %zu | %.1f |\n", scene.name, n, 2 * n * n - 2 * n, swept.crossings,
                fine.base_cells, static_cast<double>(fine.faces_in_cells) / static_cast<double>(6 * n));
  }
}

Plot plot_of(const Scene& scene, const std::vector<std::vector<Row>>& ways) {
  Plot plot{.title = scene.title,
            .x_label = "hypertrapezoids",
            .y_label = "milliseconds",
            .log_x = true,
            .log_y = true,
            .series = {},
            .levels = {},
            .x_names = {}};
  for (std::size_t w = 0; w < ways.size(); ++w) {
    Series line{kWays[w].name, {}, {}, Series::Kind::line};
    for (const Row& row : ways[w]) {
      line.x.push_back(static_cast<double>(row.count));
      line.y.push_back(1e3 * row.seconds);
    }
    plot.series.push_back(line);
  }
  return plot;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const std::size_t largest = argc > 2 ? std::max<std::size_t>(100, std::strtoull(argv[2], nullptr, 10)) : 400;
  std::filesystem::create_directories(folder);
  std::ofstream csv(folder / "fig_4_14.csv");
  csv << "scene,bodies,method,seconds,crossings,base_cells,faces_in_cells\n";
  std::vector<std::vector<std::vector<Row>>> all;
  for (const Scene& scene : kScenes) {
    auto& ways = all.emplace_back(std::size(kWays));
    for (std::size_t count = 25; count <= largest; count *= 2) {
      const Bounds bounds = scene.make(count);
      for (std::size_t w = 0; w < std::size(kWays); ++w) {
        if (!ways[w].empty() && ways[w].back().seconds > kTooLong) continue;
        const Row row = measure(bounds, kWays[w].options);
        ways[w].push_back(row);
        csv << scene.name << ',' << count << ',' << '"' << kWays[w].name << '"' << ',' << row.seconds << ','
            << row.counts.crossings << ',' << row.counts.base_cells << ',' << row.counts.faces_in_cells << '\n';
      }
    }
  }
  std::printf(
      "| scene | N | 2N^2 - 2N | crossings, projection | base cells, n_b = 4 | of them to a face |\n"
      "|---|--:|--:|--:|--:|--:|\n");
  for (std::size_t s = 0; s < all.size(); ++s) print_counts(kScenes[s], all[s]);
  std::printf(
      "\nTime in milliseconds for the largest N tried, and the exponent by which it grows from a quarter of that "
      "on.\n\n"
      "| scene ");
  for (const Way& way : kWays) std::printf("| %s ", way.name);
  std::printf("|\n|---|--:|--:|--:|--:|--:|--:|\n");
  std::vector<Plot> plots;
  for (std::size_t s = 0; s < all.size(); ++s) {
    std::printf("| %s ", kScenes[s].name);
    for (const auto& rows : all[s])
      std::printf("| %.2f for %zu, N^%.1f ", 1e3 * rows.back().seconds, rows.back().count, exponent(rows));
    std::printf("|\n");
    plots.push_back(plot_of(kScenes[s], all[s]));
  }
  orchard::plot::write_svg(folder / "fig_4.14.svg", plots, 3);
  return 0;
}
