#include "tightener.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <numeric>
#include <thread>

#include "level_finish.h"
#include "orchard/covering/inaccuracy.h"
#include "orchard/spheretree/outside_volume.h"

namespace orchard::detail {
namespace {

// A level is as coarse as its samples allow.
constexpr Index kSamplesPerBall = 8;
// Where samples end it, a level that has not so many times the balls of the one above is left out: it would cost more
// than all above and be hardly tighter.
constexpr double kWorthALevel = 1.5;
// The search in closed levels looks at every triangle in reach: of fine meshes it gets less.
constexpr double kFewTriangles = 4000;
constexpr int kTighteningRounds = 8;   // of closing a level, after those that search
constexpr double kSearchShare = 0.15;  // of the trials, in each searching round
// Levels of so few balls have hundreds of samples for each, which hide little: a part of the searching rounds will do.
constexpr Index kFewBalls = 16;
constexpr double kShareForFewBalls = 0.25;

// The starts of a first level are tried on so many samples, and with so many trials for each ball.
constexpr Index kExploringSamples = 800, kExploringTrials = 8;
// In all starts together that are tried, and that are carried through, at most: with many balls, one start is like
// another. Two are carried through where as many are tried.
constexpr Index kExploredBalls = 800, kCarriedBalls = 48;

constexpr double kLogOfPlaces =
    18;  // binary, of the places on the last level of a tree whose nodes all had so many children

// A level of more balls than this gets no more trials than one of so many, and fewer rounds: each ball then counts the
// less, and the levels below balls that are small against the triangles gain little by a search.
constexpr double kFullySearchedBalls = 1000;
// Below this share of a full search, the rounds that only tighten are left out, too; what they let go of is open again.
constexpr double kTighteningShare = 0.5;
constexpr double kTightenedTwiceShare = 0.1;  // below it, a closed level is tightened once, not twice

constexpr std::uint64_t kComparingRays = 4000;  // for the outside volume of what is compared

// Of a full search, that a level of so many balls gets.
double search_share(Index balls) { return std::min(1.0, kFullySearchedBalls / std::max<Index>(1, balls)); }

Index trials_for(Index balls, const Work& work) {
  return static_cast<Index>(search_share(balls) * work.trials * (300 + 9.0 * balls));
}

int searching_rounds(Index balls, const Work& work) {
  return static_cast<int>((balls <= kFewBalls ? kShareForFewBalls : search_share(balls)) * work.searching_rounds);
}

// How many starts of the first level are tried on few samples.
Index tried_starts(Index balls, const Work& work) {
  return std::clamp<Index>(kExploredBalls / std::max<Index>(1, balls), 1, work.explored);
}

// How many starts of a level are carried through.
Index carried_starts(Index level, Index balls, const Work& work) {
  if (level > std::size(work.starts)) return 1;
  const Index starts = work.starts[level - 1];
  if (level > 1) return starts;
  const Index worthwhile = std::max<Index>(2, kCarriedBalls / std::max<Index>(1, balls));
  return std::min({starts, worthwhile, tried_starts(balls, work)});
}

// As many as it is worth. Yet the text format has room for as many below every node: it is to stay small.
Index max_children(const TightenOptions& options) {
  if (!options.spheres.empty()) return kMaxFanOut;
  const auto roomy = static_cast<Index>(std::exp2(kLogOfPlaces / options.depth));
  return std::max(2 * options.branching, std::min(kMaxFanOut, roomy));
}

// High powers at the top: what is loose there is loose all the way down. Low ones below keep the mean low; the cap, the
// largest ball, and the size, the volume.
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

// Neither is bought with much of the other.
double mean_times_max(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()) *
         *std::max_element(values.begin(), values.end());
}

// Of balls on few samples: their volume stands for what they hold outside.
double looseness(const LevelSolver& solver) {
  std::vector<double> values;
  double volume = 0;
  for (const LevelBall& ball : solver.balls()) {
    values.push_back(ball.looseness());
    volume += ball.radius * ball.radius * ball.radius;
  }
  return mean_times_max(values) * volume;
}

// Times the outside volume: all three figures count alike.
double looseness(const Surface& surface, const Level& level) {
  std::vector<double> values(level.size());
  tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
    values[i] = inaccuracy(surface, level[i].sphere, {1e-3, 1e-2}).upper;
  });
  std::vector<Sphere> spheres;
  for (const LevelNode& node : level) spheres.push_back(node.sphere);
  const double outside = outside_volume(surface, spheres, kComparingRays);
  return mean_times_max(values) * outside;
}

}  // namespace

Tightener::Tightener(const Surface& surface, const Samples& samples, const Sphere& root, const TightenOptions& options,
                     const Work& work, const Progress& progress)
    : surface_(surface),
      samples_(samples),
      options_(options),
      work_(work),
      progress_(progress),
      partial_(root, surface.bounding_radius()) {}

TightenBuild Tightener::run() {
  TightenReport report;
  for (Index level = 1; level <= options_.depth; ++level)
    if (!build_level(level, report.levels)) break;
  SphereTree tree = partial_.tree();
  tree.branching = std::max(tree.branching, options_.branching);
  return {std::move(tree), std::move(report)};
}

bool Tightener::build_level(Index level, std::vector<TightenReport::Level>& reports) {
  const auto refined = static_cast<double>(
      std::count_if(partial_.last().begin(), partial_.last().end(), [](const LevelNode& node) { return !node.leaf; }));
  const std::size_t max = samples_.size() / kSamplesPerBall;
  const double allowed = options_.spheres.empty() ? options_.branching * refined : options_.spheres[level - 1];
  const double wanted = std::min(static_cast<double>(max), allowed);
  if (refined == 0 || (wanted <= refined && level > 1)) return false;
  if (wanted < allowed && wanted < kWorthALevel * refined) return false;
  LevelOptions level_options;
  level_options.balls = static_cast<Index>(wanted);
  level_options.max_children = level == 1 ? level_options.balls : max_children(options_);
  level_options.cost = cost_for(options_.objective, level, options_.depth);
  level_options.level = level;
  level_options.seed = options_.seed;

  const Index starts = carried_starts(level, level_options.balls, work_);
  std::vector<std::vector<LevelBall>> from(starts);
  if (level == 1) from = promising_starts(level_options, starts);
  std::vector<Candidate> all = candidates(level_options, std::move(from), [&](std::string_view, double fraction) {
    return !progress_ || progress_("tightening", (level - 1 + fraction) / options_.depth);
  });
  double search = 0, closing = 0;
  auto best = all.begin();
  for (auto next = all.begin(); next != all.end(); ++next) {
    search += next->report.seconds_search;
    closing += next->report.seconds_closing;
    if (next->looseness < best->looseness) best = next;
  }
  reports.push_back(best->report);
  reports.back().seconds_search = search;
  reports.back().seconds_closing = closing;
  take(std::move(*best));
  return true;
}

void Tightener::take(Candidate best) {
  partial_ = std::move(best.partial);
  for (std::size_t i = 0; i < partial_.last().size(); ++i) {
    LevelNode& node = partial_.last()[i];
    node.leaf = node.sphere.radius + best.center_distances[i] <= options_.refinement.allowed(node.sphere);
  }
}

// Many starts, each searched a little on few samples; the tightest of them.
std::vector<std::vector<LevelBall>> Tightener::promising_starts(LevelOptions options, Index wanted) const {
  const Index tried = tried_starts(options.balls, work_);
  if (tried <= wanted) return std::vector<std::vector<LevelBall>>(wanted);
  PartialTree partial = partial_;
  partial.add_level();
  const Samples few = samples_for(samples_, partial, kExploringSamples);
  struct Start {
    std::vector<LevelBall> balls;
    double looseness = 0;
  };
  std::vector<Start> starts(tried);
  tbb::parallel_for(Index{0}, tried, [&](Index i) {
    LevelOptions own = options;
    own.seed = seed_of(options.seed, i);
    LevelSolver solver(surface_, few, partial.paths(), own);
    solver.search(kExploringTrials * own.balls);
    solver.tighten();
    starts[i] = {solver.balls(), looseness(solver)};
  });
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.looseness < b.looseness; });
  std::vector<std::vector<LevelBall>> best;
  for (Index i = 0; i < wanted; ++i) best.push_back(std::move(starts[i].balls));
  return best;
}

// Solutions of a level, one from each start, at the same time. All are judged by the first one's unit. Those that come
// to run on the thread that called this say how far they are, and all are stopped by that.
std::vector<Tightener::Candidate> Tightener::candidates(LevelOptions options, std::vector<std::vector<LevelBall>> from,
                                                        const Progress& progress) {
  Candidate empty{partial_, 0, {}, {}};
  empty.partial.add_level();
  std::vector<Candidate> results(from.size(), empty);
  const Samples samples = samples_for(samples_, partial_, enough_samples(options.balls));
  std::deque<LevelSolver> solvers;
  for (Index start = 0; start < from.size(); ++start) {
    options.seed = seed_of(options_.seed, start);
    solvers.emplace_back(surface_, samples, empty.partial.paths(), options, std::move(from[start]));
    options.cost.unit = solvers.front().unit();
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
  // Nothing is thrown in a task: that would cut short what the others do, who would not know.
  std::exception_ptr failure;  // the first; the others were stopped by it
  const auto solve = [&](Index start) {
    try {
      search_and_finish(solvers[start], options, watched(start), results[start]);
    } catch (...) {
      if (!stopped.exchange(true)) failure = std::current_exception();
    }
  };
  tbb::task_group others;
  for (Index start = 1; start < from.size(); ++start) others.run([&solve, start] { solve(start); });
  solve(0);
  others.wait();
  if (failure) std::rethrow_exception(failure);
  if (results.size() > 1)
    for (Candidate& result : results) result.looseness = looseness(surface_, result.partial.last());
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
                       [&](std::string_view stage, double fraction) { return progress(stage, 0.4 + 0.6 * fraction); }};
  finish_level(surface_, solver, result.partial, finish, result.report);
  for (const LevelBall& ball : solver.balls()) result.center_distances.push_back(ball.center_distance);
  result.report.balls = static_cast<Index>(solver.balls().size());
  result.report.seconds_search = std::chrono::duration<double>(middle - start).count();
  result.report.seconds_closing = std::chrono::duration<double>(std::chrono::steady_clock::now() - middle).count();
}

}  // namespace orchard::detail
