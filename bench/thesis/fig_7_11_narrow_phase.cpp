// Figures 7.11 to 7.22: the narrow phase's calls in the flight simulator, sphere-trees level by level and exactly,
// against BSP-trees by both of the text's heuristics, octrees that are built at each call, and FCL in float where it is
// installed:
//   fig_7_11_narrow_phase FOLDER CALLS TREE.orchard ..
// As published: one steered and 10 drone ships of the lamp's shape, 50042 calls, the fewest-splits BSP-tree. All trees
// are of the same mesh and get the calls of the first one's flight. Each call is made four times with every engine, all
// in turn; the first is not counted, and the fastest of the others is. The clock is read after each level, 25 ns a
// time. One experiment with many tables, hence more than 300 lines.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <string>

#include "bodies.h"
#include "flight_calls.h"
#include "orchard/runtime/narrow_phase.h"
#include "svg_plot.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;
using orchard::plot::Plot;
using orchard::plot::Series;
using Clock = std::chrono::steady_clock;

constexpr int kPasses = 3;
constexpr std::size_t kExact = 9;  // in place of a level's number

double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

struct AtLevel {
  std::size_t level;  // or kExact
  Answer answer;
  double bound, microseconds;  // since the beginning of the call
};

// A call by one tree: what was known after each level, up to the one that decided.
std::vector<AtLevel> descend(NarrowPhase& pair, const Query& call) {
  std::vector<AtLevel> levels;
  const auto begin = Clock::now();
  pair.start(call.a, call.b);
  levels.push_back({0, pair.answer(), pair.separation_bound(), microseconds_since(begin)});
  while (!pair.finished()) {
    pair.refine();
    const double time = microseconds_since(begin);
    levels.push_back(
        {pair.progress().exact ? kExact : pair.progress().level, pair.answer(), pair.separation_bound(), time});
  }
  return levels;
}

double go_straight(NarrowPhase& pair, const Query& call) {
  const auto begin = Clock::now();
  pair.start(call.a, call.b);
  pair.refine_exactly();
  return microseconds_since(begin);
}

struct Engine {
  std::string name;
  std::unique_ptr<PairRival> rival;
  std::vector<double> microseconds;
  std::vector<char> touches;
};

struct Tree {
  std::string name;
  PackedSphereTree packed;
  std::vector<std::vector<AtLevel>> calls;
  std::vector<double> straight;  // microseconds from the roots to the triangles, leaving the levels between out
};

// All engines at the same call, in turn.
void measure(const std::vector<Query>& calls, std::vector<Tree>& trees, std::vector<Engine>& engines) {
  std::vector<std::unique_ptr<NarrowPhase>> pairs;
  std::deque<PreparedTree> bodies;  // stay where they are
  for (const Tree& tree : trees) {
    const PreparedTree& body = bodies.emplace_back(tree.packed);
    pairs.push_back(std::make_unique<NarrowPhase>(body, body, 1u << 20));
  }
  for (Engine& engine : engines) engine.rival->place(calls);
  for (std::size_t i = 0; i < calls.size(); ++i) {
    for (Engine& engine : engines) {
      engine.touches.push_back(engine.rival->collide(i));
      double best = 1e300;
      for (int pass = 0; pass < kPasses; ++pass) {
        const auto begin = Clock::now();
        engine.rival->collide(i);
        best = std::min(best, microseconds_since(begin));
      }
      engine.microseconds.push_back(best);
    }
    for (std::size_t t = 0; t < trees.size(); ++t) {
      std::vector<AtLevel> best = descend(*pairs[t], calls[i]);
      for (AtLevel& level : best) level.microseconds = 1e300;
      for (int pass = 0; pass < kPasses; ++pass) {
        const std::vector<AtLevel> again = descend(*pairs[t], calls[i]);
        for (std::size_t l = 0; l < best.size(); ++l)
          best[l].microseconds = std::min(best[l].microseconds, again[l].microseconds);
      }
      trees[t].calls.push_back(std::move(best));
      go_straight(*pairs[t], calls[i]);
      double straight = 1e300;
      for (int pass = 0; pass < kPasses; ++pass) straight = std::min(straight, go_straight(*pairs[t], calls[i]));
      trees[t].straight.push_back(straight);
    }
  }
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

std::string level_name(std::size_t level) { return level == kExact ? "exact" : std::to_string(level); }

std::vector<std::size_t> levels_of(const Tree& tree) {
  std::vector<std::size_t> levels;
  for (const auto& call : tree.calls)
    for (const AtLevel& at : call)
      if (at.level > 0 && std::find(levels.begin(), levels.end(), at.level) == levels.end()) levels.push_back(at.level);
  std::sort(levels.begin(), levels.end());
  return levels;
}

enum class Cases { reached, no, maybe };

struct Picked {
  std::vector<std::vector<double>> speedups;  // over each engine
  std::vector<double> bounds, microseconds;
};

// The calls that reached the level (Figs. 7.11-7.15), those of them that it decided (7.16), or that it left open
// (7.17-7.21; at the exact level, those that touch).
Picked pick(const Tree& tree, const std::vector<Engine>& engines, std::size_t level, Cases cases, double radius) {
  Picked picked{std::vector<std::vector<double>>(engines.size()), {}, {}};
  for (std::size_t i = 0; i < tree.calls.size(); ++i) {
    for (const AtLevel& at : tree.calls[i]) {
      if (at.level != level) continue;
      if (cases == Cases::no && at.answer != Answer::no) continue;
      if (cases == Cases::maybe && at.answer == Answer::no) continue;
      for (std::size_t e = 0; e < engines.size(); ++e)
        picked.speedups[e].push_back(engines[e].microseconds[i] / at.microseconds);
      if (at.answer == Answer::maybe) picked.bounds.push_back(at.bound / radius);
      picked.microseconds.push_back(at.microseconds);
    }
  }
  return picked;
}

void print_row(const std::string& tree, const std::string& what, const Picked& picked) {
  std::printf("| %s | %s | %zu ", tree.c_str(), what.c_str(), picked.microseconds.size());
  for (const auto& speedups : picked.speedups) {
    const auto slower = std::count_if(speedups.begin(), speedups.end(), [](double s) { return s < 1; });
    if (speedups.empty())
      std::printf("| - ");
    else
      std::printf("| %.2f, %zu slower ", quantile(speedups, 0.5), static_cast<std::size_t>(slower));
  }
  std::printf("| %.2f |\n", quantile(picked.microseconds, 0.5));
}

// A query that wants a yes or no and no bounds leaves the levels out, as BSP-trees and FCL do.
Picked pick_straight(const Tree& tree, const std::vector<Engine>& engines, bool touching) {
  Picked picked{std::vector<std::vector<double>>(engines.size()), {}, {}};
  for (std::size_t i = 0; i < tree.calls.size(); ++i) {
    if (tree.calls[i].size() == 1 || (tree.calls[i].back().answer != Answer::no) != touching) continue;
    for (std::size_t e = 0; e < engines.size(); ++e)
      picked.speedups[e].push_back(engines[e].microseconds[i] / tree.straight[i]);
    picked.microseconds.push_back(tree.straight[i]);
  }
  return picked;
}

// Bars of the logarithm's tenths, so that "slower" stays visible (the text shows three views of each histogram).
Series histogram(const std::string& name, const std::vector<double>& values, double low, double high) {
  constexpr int kBins = 40;
  Series line{name, {}, {}, Series::Kind::line};
  for (int i = 0; i < kBins; ++i) {
    line.x.push_back(low * std::pow(high / low, (i + 0.5) / kBins));
    line.y.push_back(0);
  }
  for (const double value : values) {
    const double at = kBins * std::log(std::max(value, low) / low) / std::log(high / low);
    line.y[static_cast<std::size_t>(std::min(at, kBins - 1.0))] += 1;
  }
  return line;
}

Plot plot_of(const std::string& title, const std::string& x, const std::string& y, std::vector<Series> series) {
  Plot plot;
  plot.title = title;
  plot.x_label = x;
  plot.y_label = y;
  plot.log_x = true;
  plot.series = std::move(series);
  return plot;
}

void draw(const std::filesystem::path& folder, const std::vector<Tree>& trees, const std::vector<Engine>& engines,
          double radius) {
  constexpr double kMin = 0.1, kMax = 1000;  // speedups
  std::vector<Plot> speedups, no_speedups, maybe_speedups, bounds;
  std::vector<Series> curves;
  for (const Tree& tree : trees) {
    std::vector<Series> all, no, still, open;
    Series curve{tree.name, {}, {}, Series::Kind::line};
    for (const std::size_t level : levels_of(tree)) {
      const std::string name = "level " + level_name(level);
      const auto bars = [&](Cases cases) {
        return histogram(name, pick(tree, engines, level, cases, radius).speedups.front(), kMin, kMax);
      };
      all.push_back(bars(Cases::reached));
      no.push_back(bars(Cases::no));
      still.push_back(bars(Cases::maybe));
      const Picked maybe = pick(tree, engines, level, Cases::maybe, radius);
      if (level == kExact) continue;
      open.push_back(histogram(name, maybe.bounds, 0.001, 2));
      curve.x.push_back(quantile(maybe.microseconds, 0.5));
      curve.y.push_back(quantile(maybe.bounds, 0.5));
    }
    const char* const over = "speedup over the BSP-tree, fewest splits";
    speedups.push_back(plot_of("Figs. 7.11-7.15: " + tree.name, over, "calls", all));
    no_speedups.push_back(plot_of("Fig. 7.16: " + tree.name, over, "calls decided with no", no));
    maybe_speedups.push_back(plot_of("Figs. 7.17-7.21: " + tree.name, over, "calls left open", still));
    bounds.push_back(plot_of("Fig. 7.22: " + tree.name, "separation bound / R", "calls left open", open));
    curves.push_back(curve);
  }
  orchard::plot::write_svg(folder / "fig_7.11.svg", speedups, 2);
  orchard::plot::write_svg(folder / "fig_7.16.svg", no_speedups, 2);
  orchard::plot::write_svg(folder / "fig_7.17.svg", maybe_speedups, 2);
  orchard::plot::write_svg(folder / "fig_7.22.svg", bounds, 2);
  Plot trade =
      plot_of("Time against accuracy, calls left open", "microseconds, median", "separation bound / R, median", curves);
  trade.log_y = true;
  orchard::plot::write_svg(folder / "time_accuracy.svg", {trade}, 1);
}

void write_csv(const std::filesystem::path& folder, const std::vector<Tree>& trees, const std::vector<Engine>& engines,
               double radius) {
  std::ofstream csv(folder / "fig_7_11.csv");
  csv << "tree,call,level,answer,bound_over_radius,microseconds";
  for (const Engine& engine : engines) csv << ',' << '"' << engine.name << '"';
  csv << '\n';
  for (const Tree& tree : trees) {
    for (std::size_t i = 0; i < tree.calls.size(); ++i) {
      for (const AtLevel& at : tree.calls[i]) {
        csv << tree.name << ',' << i << ',' << level_name(at.level) << ','
            << (at.answer == Answer::no    ? "no"
                : at.answer == Answer::yes ? "yes"
                                           : "maybe")
            << ',' << at.bound / radius << ',' << at.microseconds;
        for (const Engine& engine : engines) csv << ',' << engine.microseconds[i];
        csv << '\n';
      }
    }
  }
}

// False if an engine gives another answer than the exact level somewhere.
bool agree(const std::vector<Tree>& trees, const std::vector<Engine>& engines) {
  std::size_t differ = 0;
  for (const Tree& tree : trees)
    for (std::size_t i = 0; i < tree.calls.size(); ++i)
      for (const Engine& engine : engines)
        differ += (tree.calls[i].back().answer != Answer::no) != (engine.touches[i] != 0);
  std::printf("\nanswers that differ: %zu\n", differ);
  return differ * 1000 <= trees.size() * trees.front().calls.size();  // trees round vertices each in its own way
}

void print_head(const char* title, const char* column, const std::vector<Engine>& engines) {
  std::printf("\n%s\n\n| tree | %s | calls ", title, column);
  for (const Engine& engine : engines) std::printf("| over %s ", engine.name.c_str());
  std::printf("| microseconds |\n|---|---|---");
  for (std::size_t i = 0; i < engines.size(); ++i) std::printf("|---");
  std::printf("|---|\n");
}

void print_bounds(const std::vector<Tree>& trees, const std::vector<Engine>& engines, double radius) {
  std::printf(
      "\nBounds of the calls left open, over R (Fig. 7.22)\n\n| tree | level | open | p10 | median | p90 |\n"
      "|---|---|---|---|---|---|\n");
  for (const Tree& tree : trees) {
    for (const std::size_t level : levels_of(tree)) {
      if (level == kExact) continue;
      const Picked maybe = pick(tree, engines, level, Cases::maybe, radius);
      std::printf("| %s | %zu | %zu | %.4f | %.4f | %.4f |\n", tree.name.c_str(), level, maybe.bounds.size(),
                  quantile(maybe.bounds, 0.1), quantile(maybe.bounds, 0.5), quantile(maybe.bounds, 0.9));
    }
  }
}

void print_tables(const std::vector<Tree>& trees, const std::vector<Engine>& engines, double radius) {
  const struct {
    const char* title;
    Cases cases;
  } parts[] = {
      {"Calls that reach a level (Figs. 7.11-7.15): median speedups, and how many calls are slower", Cases::reached},
      {"Calls that a level decides with \"no\" (Fig. 7.16)", Cases::no},
      {"Calls that a level leaves open (Figs. 7.17-7.21; exact: that touch)", Cases::maybe}};
  for (const auto& [title, cases] : parts) {
    print_head(title, "level", engines);
    for (const Tree& tree : trees)
      for (const std::size_t level : levels_of(tree))
        print_row(tree.name, level_name(level), pick(tree, engines, level, cases, radius));
  }
  print_head("Straight from the roots to the triangles, of the calls that the roots leave open", "answer", engines);
  for (const Tree& tree : trees)
    for (const bool touching : {false, true})
      print_row(tree.name, touching ? "yes" : "no", pick_straight(tree, engines, touching));
  print_bounds(trees, engines, radius);
}

// The judgement of 2.3.2 and 7.2: octrees, which are built again at each call, are slower than BSP-trees.
void print_octrees(const std::vector<Tree>& trees, const Engine& bsp, const Engine& octree) {
  std::printf(
      "\nOctrees, built again at each call, against BSP-trees (2.3.2, 7.2), of the calls that the roots leave open\n\n"
      "| answer | calls | BSP-tree, median microseconds | octree | BSP-tree over octree, median | octree faster |\n"
      "|---|---|---|---|---|---|\n");
  for (const bool touching : {false, true}) {
    std::vector<double> of_bsp, of_octree, ratios;
    for (std::size_t i = 0; i < bsp.microseconds.size(); ++i) {
      if (trees.front().calls[i].size() == 1 || (bsp.touches[i] != 0) != touching) continue;
      of_bsp.push_back(bsp.microseconds[i]);
      of_octree.push_back(octree.microseconds[i]);
      ratios.push_back(of_bsp.back() / of_octree.back());
    }
    const auto faster = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > 1; });
    std::printf("| %s | %zu | %.2f | %.2f | %.2f | %.1f %% |\n", touching ? "yes" : "no", ratios.size(),
                quantile(of_bsp, 0.5), quantile(of_octree, 0.5), quantile(ratios, 0.5),
                100 * static_cast<double>(faster) / static_cast<double>(std::max<std::size_t>(1, ratios.size())));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: fig_7_11_narrow_phase FOLDER CALLS TREE.orchard ..\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  std::vector<Tree> trees;
  for (int i = 3; i < argc; ++i)
    trees.push_back({std::filesystem::path(argv[i]).stem().string(), read_body(argv[i]), {}, {}});
  const PackedSphereTree& first = trees.front().packed;
  std::vector<Engine> engines;
  const auto add = [&](std::unique_ptr<PairRival> rival) {
    if (rival) engines.push_back({rival->name(), std::move(rival), {}, {}});
  };
  add(bsp_trees(first, first, BspHeuristic::fewest_splits));
  add(bsp_trees(first, first, BspHeuristic::balanced));
  add(octree(first, first));
  const std::size_t of_octree = engines.size() - 1;
  add(fcl_float(first, first));
  const auto calls = flight_calls(first, static_cast<std::size_t>(std::atol(argv[2])), 1);
  measure(calls, trees, engines);
  const double radius = double{first.blocks[0].radius[0]};
  std::size_t touching = 0, roots = 0;
  for (const auto& call : trees.front().calls) {
    touching += call.back().answer != Answer::no;
    roots += call.size() == 1;
  }
  std::printf("%zu calls, %zu of them touching, %zu decided by the roots' spheres and hulls\n", calls.size(), touching,
              roots);
  print_tables(trees, engines, radius);
  print_octrees(trees, engines.front(), engines[of_octree]);
  const bool right = agree(trees, engines);
  draw(folder, trees, engines, radius);
  write_csv(folder, trees, engines, radius);
  return right ? 0 : 1;
}
