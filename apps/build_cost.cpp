#include "build_cost.h"

#include <fmt/format.h>

#include <cmath>

namespace orchard::apps {
namespace {

constexpr double kWorthAWord = 30;  // seconds

// Measured on the bundled models with one thread (Xeon, 2.1 GHz): seconds for each sphere, by method and effort.
double seconds_per_sphere(const SphereTreeOptions& options) {
  const int effort = options.effort == Effort::low ? 0 : options.effort == Effort::standard ? 1 : 2;
  switch (options.method) {
    case TreeMethod::tightened: {
      constexpr double kSeconds[] = {0.012, 0.024, 0.18};
      return kSeconds[effort];
    }
    case TreeMethod::annealing: {
      constexpr double kSeconds[] = {0.05, 0.15, 0.85};
      return kSeconds[effort];
    }
    case TreeMethod::merging:
      return 0.004;
    case TreeMethod::octree:
      return 0.0005;
  }
  return 0;
}

constexpr double kSecondsPerPoint = 9e-5, kBytesPerPoint = 2000, kBytesPerSphere = 1500, kBytes = 4e7;
constexpr double kSecondsPerTrial = 1e-4;  // of --descent

std::string of_time(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} seconds", std::ceil(seconds / 10) * 10);
  if (seconds < 5400) return fmt::format("{:.0f} minutes", std::ceil(seconds / 60));
  return fmt::format("{:.0f} hours", std::ceil(seconds / 3600));
}

}  // namespace

BuildCost estimated_cost(const SphereTreeOptions& options, double points) {
  BuildCost cost;
  cost.points = points;
  for (Index level = 0; level <= options.depth; ++level)
    cost.spheres += std::pow(static_cast<double>(options.branching), level);
  cost.seconds =
      points * kSecondsPerPoint + cost.spheres * (seconds_per_sphere(options) + options.descent * kSecondsPerTrial);
  cost.bytes = kBytes + points * kBytesPerPoint + cost.spheres * kBytesPerSphere;
  return cost;
}

std::string in_words(const BuildCost& cost, const SphereTreeOptions& options) {
  if (cost.seconds < kWorthAWord) return {};
  std::string text = fmt::format("up to {:.0f} spheres", cost.spheres);
  if (cost.points > 0) text += fmt::format(" from {:.0f} surface points", cost.points);
  text += fmt::format(": about {} of processor time and {:.1f} GB of memory; ", of_time(cost.seconds),
                      std::max(0.1, cost.bytes / 1e9));
  const bool searches = options.method == TreeMethod::tightened || options.method == TreeMethod::annealing;
  const bool points_cost_most = cost.points * kSecondsPerPoint > cost.seconds / 2;
  if (points_cost_most) return text + "fewer --samples take less";
  return text + (searches && options.effort != Effort::low ? "--effort low, a smaller --depth or --branching take less"
                                                           : "a smaller --depth or --branching takes less");
}

}  // namespace orchard::apps
