#include "broad_phase/window_plan.h"

#include <cmath>

namespace orchard::runtime::detail {
namespace {

// Costs in nanoseconds of one machine (2023, 2 GHz class); only their ratios matter. If one is off by a factor of two,
// the window is off by less, and the time hardly changes, because it is flat around the minimum.
constexpr double kCostOfUpdate = 600, kCostPerBody = 25, kCostPerCell = 12, kCostPerPair = 120;
// The width of a cell in spacings, by the number of axes that separate bodies. With smaller cells, a body takes more of
// them; with larger ones, each has more bodies. In space, the width is between kCellPerSpacing[3], if boxes are small,
// and kMostCellPerSpacing.
constexpr std::array<double, 4> kCellPerSpacing = {1, 2.6, 1.65, 1.45};
constexpr double kMostCellPerSpacing = 1.7;
constexpr double kLinesPerVolume = 1.9;  // the box of a ball has 1.9 times its volume
constexpr double kMostLines = 0.5;       // per body
// There are more lines if boxes take several cells each, so that fewer lines overflow: at most as many as a core's
// cache holds well, and only if pairs do not take much memory anyway.
constexpr double kLinesPerCell = 0.9, kCellsAsEver = 1.2, kLinesInCache = 11000, kManyPairsPerBody = 1;
constexpr double kMostCells = 0x1p23;  // along the extent of a sample; a quarter of those of the quantized grid
// The median distance of a point from its nearest neighbour in one, two and three dimensions, if points are spread at
// random, on average one in each unit of space.
constexpr std::array<double, 3> kNearest = {0.347, 0.470, 0.549};
constexpr double kClustered = 0.6;           // in clusters, the spacing is below this share of that of an even spread
constexpr std::size_t kMinClustered = 2000;  // clusters are looked for from so many bodies on
constexpr double kWorthLonger = 0.9;         // of the cost; the step at which a long window ends is slow
constexpr double kWindowGrowth = 1.4;        // from one window that is tried to the next

// Returns the size of the box of a mean body along each axis.
Vec3 box_of(const MeanMotion& mean, double duration) noexcept {
  const double spread = duration * (mean.drift + duration * mean.acceleration / 2);
  Vec3 box;
  for (std::size_t d = 0; d < 3; ++d) box[d] = 2 * mean.radius + spread + std::max(spread, mean.speed[d] * duration);
  return box;
}

// Returns for how many steps of a window a bound holds on average.
double lasting(double window, double cancelled) noexcept {
  return cancelled > 0 ? (1 - std::pow(1 - cancelled, window)) / cancelled : window;
}

}  // namespace

MeanMotion mean_of(std::span<const Motion> sample, const Vec3& velocity) noexcept {
  MeanMotion mean;
  const double share = 1 / static_cast<double>(std::max<std::size_t>(1, sample.size()));
  for (const Motion& m : sample) {
    mean.radius += share * m.radius;
    mean.drift += share * m.drift;
    mean.acceleration += share * m.acceleration;
    for (std::size_t d = 0; d < 3; ++d) mean.speed[d] += share * std::fabs(m.velocity[d] - velocity[d]);
  }
  return mean;
}

// The median along each axis is used, so a few bodies that fly elsewhere do not matter.
Vec3 crowd_velocity(std::span<const Motion> sample) noexcept {
  constexpr double kMuchSlower = 0.5;
  if (sample.empty()) return {};
  Vec3 median{};
  std::array<double, kSample> along;
  const auto middle = static_cast<std::ptrdiff_t>(sample.size() / 2);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < sample.size(); ++i) along[i] = sample[i].velocity[axis];
    std::nth_element(along.begin(), along.begin() + middle, along.begin() + static_cast<std::ptrdiff_t>(sample.size()));
    median[axis] = along[static_cast<std::size_t>(middle)];
  }
  const auto speed = [&](const Vec3& frame) {
    const Vec3 mean = mean_of(sample, frame).speed;
    return mean[0] + mean[1] + mean[2];
  };
  return speed(median) < kMuchSlower * speed({}) ? median : Vec3{};
}

namespace {

// Returns the spacing of most bodies if they lie in clusters, from the distances of nearest neighbours in the sample.
double spacing_in_clusters(std::span<const Motion> sample, std::size_t bodies, std::size_t axes) {
  std::array<double, kSample> nearest{};
  for (std::size_t i = 0; i < sample.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < sample.size(); ++k) {
      const Vec3 apart = sample[k].position - sample[i].position;
      least = std::min(least, k == i ? least : dot(apart, apart));
    }
    nearest[i] = least;
  }
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.begin() + static_cast<std::ptrdiff_t>(sample.size()));
  const double share = static_cast<double>(sample.size()) / static_cast<double>(bodies);
  return std::sqrt(*middle) / kNearest[axes - 1] * std::pow(share, 1 / static_cast<double>(axes));
}

// Returns the spread with the spacing and the thin axes that hold if bodies are spread evenly.
Spread spread_evenly(std::span<const Motion> sample, std::size_t bodies) {
  const std::size_t n = sample.size();
  Spread spread;
  if (n > 0) spread.middle = sample[0].position;
  if (n < 2) return spread;
  Vec3 lower{}, upper{};
  std::array<double, kSample> sorted;  // sorted as far as is needed
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < n; ++i) sorted[i] = sample[i].position[axis];
    const auto at = [&](std::size_t i) { return sorted.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t low = n / 8, high = n - 1 - low;
    std::nth_element(at(0), at(low), at(n));
    if (low < high) std::nth_element(at(low + 1), at(high), at(n));
    const double first = *std::min_element(at(0), at(low + 1)), last = *std::max_element(at(high), at(n));
    lower[axis] = sorted[low];
    upper[axis] = sorted[high];
    spread.extent[axis] = last - first;
    spread.middle[axis] = (first + last) / 2;
  }
  double inside = 0;
  for (const Motion& motion : sample) {
    const Vec3& p = motion.position;
    bool in = true;
    for (std::size_t axis = 0; axis < 3; ++axis) in = in && lower[axis] <= p[axis] && p[axis] <= upper[axis];
    inside += in;
  }
  const double there = std::max(inside, 1.0) / static_cast<double>(n) * static_cast<double>(bodies);
  std::array<std::size_t, 3> axes = {0, 1, 2};
  const Vec3 extent = upper - lower;
  std::sort(axes.begin(), axes.end(), [&](std::size_t a, std::size_t b) { return extent[a] < extent[b]; });
  const double shortest = extent[axes[0]], middle = extent[axes[1]], longest = extent[axes[2]];
  spread.spacing = std::cbrt(shortest * middle * longest / there);
  // An axis without extent is thin, too, because a product with 0 determines no spacing.
  if (spread.spacing <= shortest && shortest > 0) return spread;
  spread.thin[axes[0]] = true;
  spread.spacing = std::sqrt(middle * longest / there);
  if (spread.spacing <= middle && middle > 0) return spread;
  spread.thin[axes[1]] = true;
  spread.spacing = longest / there;
  return spread;
}

}  // namespace

Spread spread_of(std::span<const Motion> sample, std::size_t bodies) {
  const auto some = sample.first(std::min(sample.size(), kSample));
  Spread spread = spread_evenly(some, bodies);
  if (some.size() < kSample || bodies < kMinClustered) return spread;
  const auto thin = static_cast<std::size_t>(std::count(spread.thin.begin(), spread.thin.end(), true));
  const double clustered = spacing_in_clusters(some, bodies, 3 - thin);
  if (clustered < kClustered * spread.spacing) spread.spacing = clustered;
  return spread;
}

WindowPlan plan_window(const MeanMotion& mean, std::size_t bodies, const Spread& spread, double time_step,
                       double correction, Step fixed_window, double cancelled) noexcept {
  double spacing = spread.spacing;
  if (!(spacing > 0) || !std::isfinite(spacing)) spacing = std::max(4 * mean.radius, 1e-300);
  // If clusters are tiny compared with the world, cells of their spacing would leave other bodies outside of the
  // quantized grid, and those are compared with all bodies.
  const double least_cell = *std::max_element(spread.extent.begin(), spread.extent.end()) / kMostCells;

  const auto axes = static_cast<std::size_t>(std::count(spread.thin.begin(), spread.thin.end(), false));

  WindowPlan best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](Step window) {
    const Vec3 box = box_of(mean, static_cast<double>(window - 1) * time_step);
    const double longest = std::max({box[0], box[1], box[2], least_cell});
    const double filled = longest / spacing;
    const double wanted =
        axes == 3 ? std::clamp(1.2 + filled, kCellPerSpacing[3], kMostCellPerSpacing) : kCellPerSpacing[axes];
    const double share = std::max(wanted, filled), cell = share * spacing;
    double cells = 1, pairs = correction / 2, in_cell = 1;  // per body; in_cell: the bodies whose boxes begin in a cell
    double per_line = 1;
    for (std::size_t d = 0; d < 3; ++d) {
      // The middle of the world is in the middle of a cell, so boxes may fit into one cell along a thin axis.
      if (!spread.thin[d] || spread.extent[d] + box[d] > cell) cells *= 1 + box[d] / cell;
      if (spread.thin[d]) continue;
      pairs *= 2 * box[d] / spacing;
      in_cell *= share;
      per_line *= std::max(kMostCellPerSpacing, filled);
    }
    const double occupancy = cells * in_cell / 7;
    const double cost = (kCostOfUpdate / static_cast<double>(bodies) + kCostPerBody +
                         kCostPerCell * cells * (1 + occupancy / 2) + kCostPerPair * pairs) /
                        lasting(static_cast<double>(window), cancelled);
    if (cost >= (window > best.window ? least * kWorthLonger : least)) return;
    least = cost;
    const double as_ever = std::min(kMostLines, kLinesPerVolume / per_line) * static_cast<double>(bodies);
    const double more =
        pairs < kManyPairsPerBody ? kLinesPerCell * (cells - kCellsAsEver) * static_cast<double>(bodies) : 0;
    const double lines = std::max(as_ever, std::min(more, kLinesInCache));
    best = {cell, window, static_cast<std::size_t>(lines) + 1, pairs, longest <= 2.5 * mean.radius, cell > longest};
  };
  if (fixed_window > 0) {
    consider(std::min(fixed_window, kLongestWindow));
    return best;
  }
  double window = 1;
  while (window < static_cast<double>(kLongestWindow)) {
    consider(static_cast<Step>(window));
    window = std::max(window + 1, window * kWindowGrowth);
  }
  return best;
}

}  // namespace orchard::runtime::detail
