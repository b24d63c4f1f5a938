#include "trees/build_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace orchard::apps {
namespace {

constexpr double kWorthAWord = 30;  // in seconds: a longer build is announced

// Fitted to the measurements of tools/build-cost: a time for each step, most of which make a sphere; a time for each
// triangle of the mesh; and a time for each triangle that grows with the root of the number of steps. The root is a
// fit, not derived.
struct TreeRates {
  double step = 0;           // seconds
  double triangle = 0;       // seconds for each triangle and root of the number of spheres
  double triangle_once = 0;  // seconds for each triangle
};

constexpr double kSecondsPerTriangle = 1.3e-5;
constexpr double kSecondsPerPoint = 4.5e-5, kWithoutAxis = 1.5e-5;
constexpr double kBytes = 2.4e7, kBytesPerPoint = 2000, kBytesPerSphere = 1000;
constexpr double kSecondsPerTrial = 3e-5;  // of --descent, and sphere

double seconds_per_point(const TreeRequest& tree, bool axis) {
  return tree.method == TreeMethod::tightened && !axis ? kWithoutAxis : kSecondsPerPoint;
}

double bytes_per_triangle(TreeMethod method) { return method == TreeMethod::annealing ? 1300 : 560; }

int as_number(Effort effort) { return effort == Effort::low ? 0 : effort == Effort::standard ? 1 : 2; }

// A tightened level has a ball for every eight surface points at most. Balls beyond a thousand are searched less, and
// cost this share of the others.
constexpr double kPointsPerBall = 8, kFullySearched = 1000, kCostBeyond = 0.3;

// Of each level below the root, at most. points: as of estimated_cost().
std::vector<double> counts(const TreeRequest& tree, double points) {
  std::vector<double> levels(tree.spheres.begin(), tree.spheres.end());
  for (Index level = 1; tree.spheres.empty() && level <= levels_of(tree); ++level)
    levels.push_back(std::pow(static_cast<double>(tree.branching), level));
  if (tree.method == TreeMethod::tightened && points > 0)
    for (double& level : levels) level = std::min(level, std::max(1.0, points / kPointsPerBall));
  return levels;
}

// Returns the number of steps that take time: spheres, or, for simulated annealing, the searches for the children of
// one. On a level of the octree, about four times as many cubes contain surface as on the level above, not eight.
// Annealing left 19 to 33 spheres of 64 on level 2.
double steps(const TreeRequest& tree, double points) {
  const bool octree = tree.method == TreeMethod::octree, annealing = tree.method == TreeMethod::annealing;
  if (!octree && !annealing) {
    const double beyond = tree.method == TreeMethod::tightened ? kCostBeyond : 1;
    double result = 1;
    for (const double level : counts(tree, points))
      result += std::min(level, kFullySearched) + beyond * std::max(0.0, level - kFullySearched);
    return result;
  }
  const double first = octree ? 12 : static_cast<double>(tree.branching);
  double result = 1;
  for (Index level = 1; level <= levels_of(tree) - (annealing ? 1 : 0); ++level)
    result += std::min(std::pow(static_cast<double>(tree.branching), level), first * std::pow(4.0, level - 1.0));
  return result;
}

TreeRates rates(const TreeRequest& tree) {
  const int effort = as_number(tree.effort);
  switch (tree.method) {
    case TreeMethod::tightened: {
      constexpr double kSphere[] = {0.0018, 0.003, 0.028}, kTriangle[] = {0, 3e-7, 4e-5};
      return {kSphere[effort], kTriangle[effort], 0};
    }
    case TreeMethod::annealing: {
      // Every level divides all triangles among its searches.
      constexpr double kSearch[] = {0.04, 0.08, 0.5}, kLevel[] = {9e-5, 2.5e-4, 1.2e-3};
      return {kSearch[effort], 0, kLevel[effort] * levels_of(tree)};
    }
    case TreeMethod::merging:
      return {0.0009, 1e-7, 0};
    case TreeMethod::octree:
      return {0.0004, 0, 0};
  }
  return {};
}

// As much as the method annealing.
double annealing_afterwards(TreeRequest tree, double triangles) {
  tree.method = TreeMethod::annealing;
  const TreeRates rate = rates(tree);
  return steps(tree, 0) * rate.step + triangles * rate.triangle_once;
}

std::string of_time(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} seconds", std::ceil(seconds / 10) * 10);
  if (seconds < 5400) return fmt::format("{:.0f} minutes", std::ceil(seconds / 60));
  return fmt::format("{:.0f} hours", std::ceil(seconds / 3600));
}

}  // namespace

BuildCost estimated_cost(const TreeRequest& tree, bool axis, double points, double triangles) {
  BuildCost cost;
  cost.points = points;
  const std::vector<double> levels = counts(tree, points);
  cost.spheres = std::accumulate(levels.begin(), levels.end(), 1.0);
  const double spheres = steps(tree, points);
  const TreeRates rate = rates(tree);
  const double of_triangle = kSecondsPerTriangle + rate.triangle * std::sqrt(spheres) + rate.triangle_once;
  cost.seconds_of_points = points * seconds_per_point(tree, axis);
  cost.seconds =
      cost.seconds_of_points + spheres * (rate.step + tree.descent_trials * kSecondsPerTrial) + triangles * of_triangle;
  if (tree.anneal) cost.seconds += annealing_afterwards(tree, triangles);
  cost.bytes =
      kBytes + points * kBytesPerPoint + spheres * kBytesPerSphere + triangles * bytes_per_triangle(tree.method);
  return cost;
}

std::string in_words(const BuildCost& cost, const TreeRequest& tree, bool always) {
  if (cost.seconds < kWorthAWord && !always) return {};
  std::string text = fmt::format("up to {:.0f} spheres", cost.spheres);
  if (cost.points > 0) text += fmt::format(" from {:.0f} surface points", cost.points);
  text += fmt::format(": about {} of processor time and {:.1f} GB of memory", of_time(cost.seconds),
                      std::max(0.1, cost.bytes / 1e9));
  if (cost.seconds < kWorthAWord) return text;
  const bool searches = tree.method == TreeMethod::tightened || tree.method == TreeMethod::annealing;
  const bool points_cost_most = cost.seconds_of_points > cost.seconds / 2;
  if (points_cost_most) return text + "; fewer --samples take less";
  return text + (searches && tree.effort != Effort::low ? "; --effort low, a smaller --depth or --branching take less"
                                                        : "; a smaller --depth or --branching takes less");
}

nlohmann::json to_json(const BuildCost& cost) {
  return {{"spheres", cost.spheres}, {"points", cost.points}, {"seconds", cost.seconds}, {"bytes", cost.bytes}};
}

}  // namespace orchard::apps
