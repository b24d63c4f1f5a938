#include "tightener.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <iterator>
#include <numeric>
#include <optional>
#include <thread>

#include "level_finish.h"
#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/outside_volume.h"
#include "uncovered_regions.h"

namespace orchard::detail {
namespace {

// The smallest number of samples for each ball of a level.
constexpr Index kSamplesPerBall = 8;
// If the number of samples limits a level, the level is left out unless it has this many times the balls of the level
// above. It would cost more than all levels above and be hardly tighter.
constexpr double kWorthALevel = 1.5;
// The search in levels that cover the surface tests every triangle in reach, so it is shortened for meshes with more
// than this number of triangles.
constexpr double kFewTriangles = 4000;
constexpr int kTighteningRounds = 8;   // rounds of closing a level after the rounds with search
constexpr double kSearchShare = 0.15;  // the share of the trials in each round with search
// Levels of at most this many balls have hundreds of samples for each ball, so fewer rounds with search suffice.
constexpr Index kFewBalls = 16;
constexpr double kShareForFewBalls = 0.25;

// The numbers of samples and of trials with which the starts of a first level are compared.
constexpr Index kExploringSamples = 800, kExploringPerBall = 32, kExploringTrials = 8;
// The maximum number of balls in all starts that are compared, and in all that are completed. With many balls, starts
// differ little. At least two starts are completed if two are compared.
constexpr Index kExploredBalls = 800, kCarriedBalls = 48;

constexpr double kLogOfPlaces =
    18;  // binary, of the places on the last level of a tree whose nodes all had so many children

// A level of more balls than this gets no more trials than a level of this many balls, and fewer rounds. A single ball
// matters less there, and levels below balls that are small compared with the triangles gain little by a search.
constexpr double kFullySearchedBalls = 1000;
// If the search is shortened to less than this share, the rounds that only tighten are left out, too, because they
// would uncover parts of the surface again.
constexpr double kTighteningShare = 0.5;
constexpr double kTightenedTwiceShare =
    0.1;  // below this share, a level that covers the surface is tightened once, not twice

constexpr std::uint64_t kComparingRays = 4000;  // for the outside volumes of candidates
constexpr Index kStartsForMaximum = 2;          // starts of the first level that also use the objective `maximum`
// Levels whose figures differ by less than this, in R, count as equally tight, because the figures are not more
// precise.
constexpr double kSameTightness = tolerance::kInaccuracy;
// If the mean measure of the balls is more than this many times their mean inaccuracy, other measures may fit better.
constexpr double kFarAbove = 1.25;
// Levels that satisfy the rule by less than this part of R are prevented from growing further.
constexpr double kCloseCall = 0.002;
// If a level exceeds the figures of a given tree, it is tried again with more weight on the size, because the outside
// volume is usually the figure that is exceeded.
constexpr int kAttempts = 2;
constexpr double kMoreSizePower = 0.25;

// Returns the share of a full search that a level with this number of balls gets.
double search_share(Index balls) { return std::min(1.0, kFullySearchedBalls / std::max<Index>(1, balls)); }

Index trials_for(Index balls, const Work& work) {
  return static_cast<Index>(search_share(balls) * work.trials * (300 + 9.0 * balls));
}

int searching_rounds(Index balls, const Work& work) {
  return static_cast<int>((balls <= kFewBalls ? kShareForFewBalls : search_share(balls)) * work.searching_rounds);
}

// Returns the number of starts of the first level that are compared on few samples.
Index tried_starts(Index balls, const Work& work) {
  return std::clamp<Index>(kExploredBalls / std::max<Index>(1, balls), 1, work.explored);
}

// Returns the number of starts of a level that are completed.
Index carried_starts(Index level, Index balls, const Work& work) {
  if (level > std::size(work.starts)) return 1;
  const Index starts = work.starts[level - 1];
  if (level > 1) return starts;
  const Index worthwhile = std::max<Index>(2, kCarriedBalls / std::max<Index>(1, balls));
  return std::min({starts, worthwhile, tried_starts(balls, work)});
}

// Returns the maximum number of children of a node. More children help, but the text format has places for this number
// below every node, so it must stay small.
Index max_children(const TightenOptions& options) {
  if (!options.spheres.empty()) return kMaxFanOut;
  const auto roomy = static_cast<Index>(std::exp2(kLogOfPlaces / options.depth));
  return std::max(2 * options.branching, std::min(kMaxFanOut, roomy));
}

// Returns the cost of a level. Upper levels have high powers, because a loose ball there makes all balls below it
// loose. On lower levels, a low power minimises the mean, the cap limits the loosest ball, and the power of the radius
// limits the volume.
LevelCost cost_for(Objective objective, Index level, Index depth) {
  switch (objective) {
    case Objective::balanced:
      if (level == 1) return {.power = 8, .size_power = 0.3};
      if (level < depth) return {.power = 1.8, .cap = 1.9, .size_power = 0.4};
      return {.power = 1.2, .cap = 2.4, .size_power = 0.7};
    case Objective::maximum:
      return {.power = 10};
    case Objective::mean:
      return {.power = level < depth ? 3.0 : 1.5};
    case Objective::volume:
      return {.power = level == 1 ? 2.0 : 3.0, .size_power = 2};
  }
  return {};
}

std::uint64_t seed_of(std::uint64_t seed, Index start) { return seed + 0x100000001u * start; }

// Returns the product of mean and maximum, so that neither is reduced at a high cost of the other.
double mean_times_max(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()) *
         *std::max_element(values.begin(), values.end());
}

// Returns the looseness of balls on few samples. The volume of the balls stands for the volume outside.
double looseness(const LevelSolver& solver, const WeightField& weights) {
  std::vector<double> values;
  double volume = 0;
  for (const LevelBall& ball : solver.balls()) {
    values.push_back(ball.looseness() * weights.at(ball.center));
    volume += ball.radius * ball.radius * ball.radius;
  }
  return mean_times_max(values) * volume;
}

std::vector<Index> spheres_by_level(const TightenOptions& options) {
  if (!options.spheres.empty()) return options.spheres;
  std::vector<Index> spheres;
  double max = 1;
  for (Index level = 1; level <= options.depth; ++level) {
    max = std::min(max * options.branching, 1e9);
    spheres.push_back(static_cast<Index>(max));
  }
  return spheres;
}

}  // namespace

Tightener::Tightener(const Surface& surface, const Samples& samples, const Sphere& root, const TightenOptions& options,
                     const Work& work, const WeightField& weights, const Progress& progress)
    : surface_(surface),
      samples_(samples),
      options_(options),
      work_(work),
      weights_(weights),
      progress_(progress),
      spheres_(spheres_by_level(options)),
      root_(root),
      octree_(surface, spheres_),
      partial_(root, surface.bounding_radius()) {
  inaccuracies_ = inaccuracies(surface, partial_.last());
}

TightenBuild Tightener::run() {
  Index level = 1;
  while (level <= options_.depth && build_level(level)) ++level;
  return result();
}

TightenBuild Tightener::run_beside(const Tightener& other, Index same, std::span<const LevelLooseness> allowed,
                                   const SphereTree& octree) {
  restore_from(other, same);
  report_.levels.assign(other.report_.levels.begin(), other.report_.levels.begin() + same);
  for (Index level = same + 1; level < allowed.size(); ++level)
    build_level_beside(level, other, {allowed[level], octree});
  return result();
}

TightenBuild Tightener::result() {
  SphereTree tree = partial_.tree();
  // The original root covers the surface even if the root has grown because of the levels below it.
  if (octree_.root().radius < tree.nodes[0].sphere.radius) tree.nodes[0].sphere = octree_.root();
  tree.branching = std::max(tree.branching, options_.branching);
  return {std::move(tree), report_};
}

// Restores the other tightener's levels down to this one, as they are after its lower levels were built.
void Tightener::restore_from(const Tightener& other, Index level) {
  partial_ = other.partial_.down_to(level);
  excesses_.assign(other.excesses_.begin(), other.excesses_.begin() + level + 1);
  inaccuracies_ = inaccuracies(surface_, partial_.last());
  octree_levels_ = std::min(other.octree_levels_, level);
  differs_ = false;
}

LevelCost Tightener::cost_by(Objective objective, Index level) const {
  LevelCost cost = cost_for(objective, level, options_.depth);
  if (!weights_.empty()) cost.weights = &weights_;
  return cost;
}

LevelOptions Tightener::options_for(Index level, Index balls) const {
  LevelOptions options;
  options.balls = balls;
  options.max_children = level == 1 ? balls : max_children(options_);
  options.cost = cost_by(options_.objective, level);
  options.level = level;
  options.seed = options_.seed;
  options.keep_above = *std::max_element(excesses_.begin(), excesses_.end()) > -kCloseCall;
  return options;
}

// Returns the options of the next level, or nullopt if there is no next level.
std::optional<LevelOptions> Tightener::next_level(Index level) const {
  const auto refined = static_cast<double>(
      std::count_if(partial_.last().begin(), partial_.last().end(), [](const LevelNode& node) { return !node.leaf; }));
  const std::size_t max = samples_.size() / kSamplesPerBall;
  const double allowed = options_.spheres.empty() ? options_.branching * refined : options_.spheres[level - 1];
  const double wanted = std::min(static_cast<double>(max), allowed);
  if (refined == 0 || (wanted <= refined && level > 1)) return {};
  if (wanted < allowed && wanted < kWorthALevel * refined) return {};
  return options_for(level, static_cast<Index>(wanted));
}

bool Tightener::build_level(Index level) {
  const std::optional<LevelOptions> options = next_level(level);
  if (!options) return false;
  std::vector<Candidate> all;
  add_candidates(usual_starts(*options), all);
  const Candidate& usual = tightest(all);
  if (usual.excess > 0 || (level == 1 && !usual.measures_well)) add_other_candidates(*options, all);
  if (tightest(all).excess > 0) {
    if (level > octree_levels_ + 1) {
      partial_ = octree_.levels({root_, surface_.bounding_radius()}, level - 1);
      inaccuracies_ = inaccuracies(surface_, partial_.last());
      octree_levels_ = level - 1;
      std::fill(excesses_.begin() + 1, excesses_.end(), 0.0);
      all.clear();
      add_other_candidates(next_level(level).value_or(*options), all);
    }
    all.push_back(octree_level(level));
    judge(all.back(), options->balls, true);
  }
  take_tightest(all);
  return true;
}

// Builds a level below the present levels. If no cover satisfies the limits, it builds the level below the levels of
// the other tightener. If that fails, too, it copies the level of the other one.
void Tightener::build_level_beside(Index level, const Tightener& other, const AllowedLooseness& allowed) {
  if (take_cover_within(level, other.partial_, allowed)) return;
  const bool differed = differs_;
  restore_from(other, level - 1);
  if (differed && take_cover_within(level, other.partial_, allowed)) return;
  restore_from(other, level);
  report_.levels.push_back(other.report_.levels[level - 1]);
}

// Searches covers as usual, but balls that are looser than the loosest of the usual tree cost much more, because most
// covers would exceed the limits by their maximum. Returns false if no cover satisfies the limits.
bool Tightener::take_cover_within(Index level, const PartialTree& usual, const AllowedLooseness& allowed) {
  std::optional<LevelOptions> options = next_level(level);
  if (!options) return false;
  options->keep_above = true;
  for (const LevelNode& node : usual.levels()[level])
    options->cost.limit =
        std::max(options->cost.limit, node.sphere.radius + surface_.signed_distance(node.sphere.center));
  std::vector<Start> starts = usual_starts(*options);
  std::vector<Candidate> all;
  for (int attempt = 0; attempt < (level == 1 ? 1 : kAttempts); ++attempt) {
    if (attempt > 0)
      for (Start& start : starts) start.options.cost.size_power += kMoreSizePower;
    std::vector<Candidate> more;
    add_candidates(starts, more);
    hold_to(allowed, more);
    std::move(more.begin(), more.end(), std::back_inserter(all));
    if (tightest(all).excess <= 0) break;
  }
  if (tightest(all).excess > 0) return false;
  take_tightest(all);
  differs_ = true;
  return true;
}

void Tightener::take_tightest(std::vector<Candidate>& all) {
  Candidate& best = tightest(all);
  if (best.is_octree) octree_levels_ = static_cast<Index>(best.partial.size() - 1);
  TightenReport::Level& report = report_.levels.emplace_back(best.report);
  report.seconds_search = report.seconds_closing = 0;
  for (const Candidate& candidate : all) {
    report.seconds_search += candidate.report.seconds_search;
    report.seconds_closing += candidate.report.seconds_closing;
  }
  take(std::move(best));
}

// Sets the excess of each candidate: the amount by which it exceeds a limit. Candidates within the limits are compared
// by the product of their figures.
void Tightener::hold_to(const AllowedLooseness& within, std::vector<Candidate>& all) const {
  const auto& [allowed, octree] = within;
  const double radius = surface_.bounding_radius();
  for (Candidate& candidate : all) {
    const LevelLooseness own = looseness_by_level(candidate.partial.tree(), octree, surface_).back();
    candidate.looseness = own.product();
    if (!own.is_within(allowed))
      candidate.excess =
          std::max({candidate.excess, (own.mean - allowed.mean) / radius, (own.max - allowed.max) / radius,
                    (own.outside_volume / allowed.outside_volume - 1)});
  }
}

// Returns the tightest candidate that satisfies the rule or, if there is none, the one that breaks it least.
Tightener::Candidate& Tightener::tightest(std::vector<Candidate>& all) {
  return *std::min_element(all.begin(), all.end(), [](const Candidate& one, const Candidate& other) {
    if ((one.excess <= 0) != (other.excess <= 0)) return one.excess <= 0;
    return one.excess <= 0 ? one.looseness < other.looseness : one.excess < other.excess;
  });
}

void Tightener::add_candidates(std::vector<Start> starts, std::vector<Candidate>& all) {
  const LevelOptions options = starts[0].options;
  std::vector<Candidate> more = candidates(std::move(starts), [&](std::string_view, double fraction) {
    return !progress_ || progress_("tightening", (options.level - 1 + fraction) / options_.depth);
  });
  const bool compared = more.size() > 1 || !all.empty();
  for (Candidate& candidate : more) {
    judge(candidate, options.balls, compared);
    all.push_back(std::move(candidate));
  }
}

// Adds candidates from other starts: from all of them for the first level, which is small, and for other levels until
// one satisfies the rule.
void Tightener::add_other_candidates(const LevelOptions& options, std::vector<Candidate>& all) {
  std::vector<Start> starts = other_starts(options);
  if (options.level == 1) return add_candidates(std::move(starts), all);
  for (Start& start : starts) {
    add_candidates({std::move(start)}, all);
    if (tightest(all).excess <= 0) return;
  }
}

// Replaces each ball that is looser than its parent by a copy of the parent, which contains the same part of the
// surface.
void Tightener::cap(Candidate& candidate) const {
  for (std::size_t i = 0; i < candidate.inaccuracies.size(); ++i) {
    LevelNode& node = candidate.partial.last()[i];
    if (candidate.inaccuracies[i] <= inaccuracies_[node.parent]) continue;
    node.sphere = partial_.last()[node.parent].sphere;
    candidate.inaccuracies[i] = inaccuracies_[node.parent];
    candidate.center_distances[i] = surface_.signed_distance(node.sphere.center);
  }
}

// Returns by how much a level with this tightness exceeds the rule, as a part of R; at most 0 if it satisfies the rule.
double Tightener::excess(const LevelTightness& level, Index balls) {
  if (!goes_on_everywhere(options_.refinement)) return 0;
  const LevelTightness above = tightness(inaccuracies_), octree = octree_.bound(balls);
  const double mean = level.mean - std::min(above.mean, octree.mean), max = level.max - std::min(above.max, octree.max);
  return std::max(mean, max) / surface_.bounding_radius() - kSameTightness;
}

// Returns the same for the levels above it, whose balls may have grown.
double Tightener::excess_above(const Candidate& candidate) const {
  double excess = -1;
  for (std::size_t l = 0; l + 1 < candidate.partial.size(); ++l) {
    double grown = 0;
    const Level &before = partial_.levels()[l], &after = candidate.partial.levels()[l];
    for (std::size_t i = 0; i < before.size(); ++i)
      grown = std::max(grown, after[i].sphere.radius - before[i].sphere.radius);
    excess = std::max(excess, excesses_[l] + grown / surface_.bounding_radius());
  }
  return excess;
}

// Judges a candidate. The measure of the balls bounds their inaccuracy, which usually suffices to know that the rule
// holds.
void Tightener::judge(Candidate& candidate, Index balls, bool by_looseness) {
  const Level& level = candidate.partial.last();
  std::vector<double> reach(level.size());
  for (std::size_t i = 0; i < level.size(); ++i) {
    reach[i] = std::max(0.0, level[i].sphere.radius + candidate.center_distances[i]);
  }
  candidate.excess = excess(tightness(reach), balls);
  if (candidate.excess > 0) {
    candidate.inaccuracies = inaccuracies(surface_, level);
    candidate.excess = excess(tightness(candidate.inaccuracies), balls);
    if (candidate.excess > 0) {
      cap(candidate);
      candidate.excess = excess(tightness(candidate.inaccuracies), balls);
    }
  }
  candidate.excess = std::max(candidate.excess, excess_above(candidate));
  if (!by_looseness && candidate.inaccuracies.empty()) return;
  // An estimate is enough, because all starts are compared by the same values.
  std::vector<double> values(level.size());
  tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
    values[i] = inaccuracy(surface_, level[i].sphere, {1e-3, 1e-2}).upper;
  });
  candidate.measures_well = tightness(reach).mean <= kFarAbove * tightness(values).mean;
  std::vector<Sphere> spheres;
  for (const LevelNode& node : level) spheres.push_back(node.sphere);
  candidate.looseness = mean_times_max(values) * outside_volume(surface_, spheres, kComparingRays);
}

void Tightener::take(Candidate best) {
  inaccuracies_ =
      best.inaccuracies.empty() ? inaccuracies(surface_, best.partial.last()) : std::move(best.inaccuracies);
  partial_ = std::move(best.partial);
  excesses_.push_back(best.excess);
  for (std::size_t i = 0; i < partial_.last().size(); ++i) {
    LevelNode& node = partial_.last()[i];
    node.leaf = node.sphere.radius + best.center_distances[i] <= options_.refinement.allowed(node.sphere);
  }
}

// Returns starts from different seeds. For the first level, some use another objective, which sometimes leads to a
// better result for the requested one.
std::vector<Tightener::Start> Tightener::usual_starts(const LevelOptions& options) const {
  const Index count = carried_starts(options.level, options.balls, work_);
  std::vector<std::vector<LevelBall>> from(count);
  if (options.level == 1) from = promising_starts(options, count);
  std::vector<Start> starts;
  for (Index i = 0; i < count; ++i) {
    starts.push_back({options, from[i]});
    starts.back().options.seed = seed_of(options_.seed, i);
  }
  if (options.level > 1 || options_.objective != Objective::balanced) return starts;
  for (Index i = 0; i < std::min(count, kStartsForMaximum); ++i) {
    starts.push_back(starts[i]);
    starts.back().options.cost = cost_by(Objective::maximum, options.level);
    starts.back().options.cost.limit = options.cost.limit;
    starts.back().kind = 1;
  }
  return starts;
}

// Returns starts with both measures and with the objective `maximum`, from the octree and from seeds.
std::vector<Tightener::Start> Tightener::other_starts(const LevelOptions& options) const {
  PartialTree partial = partial_;
  partial.add_level();
  const PathRegions regions(samples_for(samples_, partial_, enough_samples(options.balls)), partial.paths());
  const std::vector<LevelBall> cubes = octree_.start(regions, options.balls, options.max_children);
  LevelOptions usual = options, by_maximum = options;
  usual.keep_above = by_maximum.keep_above = true;
  by_maximum.cost = cost_by(Objective::maximum, options.level);
  LevelOptions by_radius = options, by_max_radius = by_maximum;
  by_radius.measure = by_max_radius.measure = BallMeasure::radius;
  std::vector<Start> starts{{usual, cubes, 0}, {by_maximum, {}, 1}, {by_radius, cubes, 2}, {by_max_radius, cubes, 3}};
  if (options.level > 1) return starts;
  for (const std::vector<LevelBall>& balls : promising_starts(by_maximum, 2)) starts.push_back({by_maximum, balls, 1});
  starts.push_back({by_radius, promising_starts(by_radius, 1)[0], 2});
  return starts;
}

// Returns the level of the octree, unchanged.
Tightener::Candidate Tightener::octree_level(Index level) const {
  Candidate candidate{octree_.levels({root_, surface_.bounding_radius()}, level)};
  for (const LevelNode& node : candidate.partial.last())
    candidate.center_distances.push_back(surface_.signed_distance(node.sphere.center));
  candidate.report.balls = static_cast<Index>(candidate.partial.last().size());
  candidate.is_octree = true;
  return candidate;
}

// Returns the tightest of many starts, each of which is searched briefly on few samples.
std::vector<std::vector<LevelBall>> Tightener::promising_starts(LevelOptions options, Index wanted) const {
  const Index tried = tried_starts(options.balls, work_);
  if (tried <= wanted) return std::vector<std::vector<LevelBall>>(wanted);
  PartialTree partial = partial_;
  partial.add_level();
  const Samples few = samples_for(samples_, partial, std::max(kExploringSamples, kExploringPerBall * options.balls));
  struct Tried {
    std::vector<LevelBall> balls;
    double looseness = 0;
  };
  std::vector<Tried> starts(tried);
  tbb::parallel_for(Index{0}, tried, [&](Index i) {
    LevelOptions own = options;
    own.seed = seed_of(options.seed, i);
    LevelSolver solver(surface_, few, partial.paths(), own);
    solver.search(kExploringTrials * own.balls);
    solver.tighten();
    starts[i] = {solver.balls(), looseness(solver, weights_)};
  });
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Tried& a, const Tried& b) { return a.looseness < b.looseness; });
  std::vector<std::vector<LevelBall>> best;
  for (Index i = 0; i < wanted; ++i) best.push_back(std::move(starts[i].balls));
  return best;
}

// Solves a level from each start, in parallel. Starts of one kind use the unit of the first one. Those that run on the
// calling thread report progress; if that cancels, all stop.
std::vector<Tightener::Candidate> Tightener::candidates(std::vector<Start> starts, const Progress& progress) const {
  Candidate empty{partial_};
  empty.partial.add_level();
  std::vector<Candidate> results(starts.size(), empty);
  const Samples samples = samples_for(samples_, partial_, enough_samples(starts[0].options.balls));
  std::deque<LevelSolver> solvers;
  for (Start& start : starts) {
    const auto like = std::find_if(starts.begin(), starts.end(), [&](const Start& s) { return s.kind == start.kind; });
    if (&*like != &start) start.options.cost.unit = solvers[static_cast<std::size_t>(like - starts.begin())].unit();
    solvers.emplace_back(surface_, samples, empty.partial.paths(), start.options, std::move(start.balls));
  }
  std::atomic<bool> stopped = false;
  const std::thread::id caller = std::this_thread::get_id();
  double reported = 0;
  const auto watched = [&](Index start) -> Progress {
    return [&, start](std::string_view stage, double fraction) {
      if (stopped || std::this_thread::get_id() != caller) return !stopped;
      reported = std::max(reported, (start + fraction) / static_cast<double>(solvers.size()));
      return !progress || progress(stage, reported);
    };
  };
  // Tasks do not throw, because an exception would end other tasks in the middle.
  std::exception_ptr failure;  // the first exception, which stopped the others
  const auto solve = [&](Index start) {
    try {
      search_and_finish(solvers[start], starts[start].options, watched(start), results[start]);
    } catch (...) {
      if (!stopped.exchange(true)) failure = std::current_exception();
    }
  };
  tbb::task_group others;
  for (Index start = 1; start < starts.size(); ++start) others.run([&solve, start] { solve(start); });
  solve(0);
  others.wait();
  if (failure) std::rethrow_exception(failure);
  return results;
}

void Tightener::search_and_finish(LevelSolver& solver, const LevelOptions& options, const Progress& progress,
                                  Candidate& result) const {
  const auto start = std::chrono::steady_clock::now();
  const Index trials = trials_for(options.balls, work_);
  solver.tighten();
  solver.search(trials, [&](std::string_view stage, double fraction) { return progress(stage, 0.4 * fraction); });
  solver.tighten();
  const auto middle = std::chrono::steady_clock::now();
  const double fineness = static_cast<double>(surface_.mesh().triangles.size()) / kFewTriangles;
  const double share = search_share(options.balls);
  const double closed_trials = share * work_.closed_trials / std::max(1.0, fineness);
  FinishOptions finish{searching_rounds(options.balls, work_),
                       share < kTighteningShare ? 0 : kTighteningRounds,
                       share < kTightenedTwiceShare ? 1 : 2,
                       static_cast<Index>(kSearchShare * trials),
                       static_cast<Index>(closed_trials * static_cast<double>(solver.balls().size())),
                       options.keep_above,
                       [&](std::string_view stage, double fraction) { return progress(stage, 0.4 + 0.6 * fraction); }};
  finish_level(surface_, solver, result.partial, finish, result.report);
  const bool is_known = options.measure == BallMeasure::reach;
  for (const LevelBall& ball : solver.balls())
    result.center_distances.push_back(is_known ? ball.center_distance : surface_.signed_distance(ball.center));
  result.report.balls = static_cast<Index>(solver.balls().size());
  result.report.seconds_search = std::chrono::duration<double>(middle - start).count();
  result.report.seconds_closing = std::chrono::duration<double>(std::chrono::steady_clock::now() - middle).count();
}

}  // namespace orchard::detail
