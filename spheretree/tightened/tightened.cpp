#include "orchard/spheretree/tightened.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "level_finish.h"
#include "level_samples.h"
#include "level_solver.h"
#include "orchard/geometry/error.h"
#include "partial_tree.h"

namespace orchard {
namespace {

using detail::LevelCost;
using detail::LevelNode;
using detail::LevelSolver;
using detail::PartialTree;
using detail::Samples;

// A level is as coarse as its samples allow.
constexpr Index kSamplesPerBall = 8;

// How much work the levels get; of everything, the best of some starts is kept.
struct Work {
  double trials;         // of the neighbourhood search, as a multiple of the standard number
  int searching_rounds;  // of closing a level: those in which the search goes on
  double closed_trials;  // for each ball of a level, of the search in closed levels
  Index starts[2];       // of the first level, of the second
};
Work work_for(Effort effort) {
  switch (effort) {
    case Effort::low:
      return {0.25, 2, 0, {1, 1}};
    case Effort::standard:
      return {1, 6, 1, {2, 1}};
    case Effort::high:
      return {3, 10, 24, {8, 3}};
  }
  return {1, 6, 1, {2, 1}};
}
// The search in closed levels looks at every triangle in reach: of fine meshes it gets less.
constexpr double kFewTriangles = 4000;
constexpr double kSearchShare = 0.1;  // of the trials, in each searching round
Index trials_for(Index balls, const Work& work) { return static_cast<Index>(work.trials * (300 + 14.0 * balls)); }

// High powers at the top: what is loose there is loose all the way down. The more trials, the lower the sum, at the
// cost of the largest ball unless the cap is lower too.
LevelCost cost_for(Objective objective, Index level, Index depth, Effort effort) {
  switch (objective) {
    case Objective::balanced:
      if (level == 1) return {.power = 8};
      if (level < depth) return {.power = 3, .cap = effort == Effort::high ? 1.6 : 2.0};
      return {.power = 2, .cap = 2.5};
    case Objective::maximum:
      return {.power = 10};
    case Objective::mean:
      return {.power = level < depth ? 3.0 : 1.5};
    case Objective::volume:
      return {.power = level == 1 ? 2.0 : 3.0, .size_power = 2};
  }
  return {};
}

struct Candidate {
  PartialTree partial;
  double objective;
  std::vector<double> center_distances;  // signed distances of the last level's centres
  TightenReport::Level report;
};

class Tightener {
 public:
  Tightener(const Surface& surface, const MedialAxis& axis, const TightenOptions& options, const Progress& progress)
      : surface_(surface),
        options_(options),
        progress_(progress),
        work_(work_for(options.effort)),
        samples_(detail::surface_samples(surface, axis)),
        partial_(surface) {}

  TightenBuild run() {
    TightenReport report;
    for (Index level = 1; level <= options_.depth; ++level)
      if (!build_level(level, report.levels)) break;
    SphereTree tree = partial_.tree();
    tree.branching = std::max(tree.branching, options_.branching);
    return {std::move(tree), std::move(report)};
  }

 private:
  bool build_level(Index level, std::vector<TightenReport::Level>& reports) {
    const auto refined = static_cast<double>(std::count_if(partial_.last().begin(), partial_.last().end(),
                                                           [](const LevelNode& node) { return !node.leaf; }));
    const std::size_t max = samples_.size() / kSamplesPerBall;
    const double wanted = std::min(static_cast<double>(max), options_.branching * refined);
    if (refined == 0 || (wanted <= refined && level > 1)) return false;
    detail::LevelOptions level_options;
    level_options.balls = static_cast<Index>(wanted);
    level_options.max_children = std::min<Index>(64, 2 * options_.branching);
    level_options.cost = cost_for(options_.objective, level, options_.depth, options_.effort);
    level_options.level = level;

    std::optional<Candidate> best;
    const Index starts = level <= std::size(work_.starts) && level < options_.depth ? work_.starts[level - 1] : 1;
    double search = 0, closing = 0;
    for (Index start = 0; start < starts; ++start) {
      level_options.seed = options_.seed + 0x100000001u * start;
      const double begin = (start + 0.0) / starts, share = 1.0 / starts;
      Candidate next = candidate(level_options, [&](std::string_view, double fraction) {
        return !progress_ || progress_("tightening", (level - 1 + begin + share * fraction) / options_.depth);
      });
      search += next.report.seconds_search;
      closing += next.report.seconds_closing;
      if (!best || next.objective < best->objective) best.emplace(std::move(next));
    }
    partial_ = std::move(best->partial);
    reports.push_back(best->report);
    reports.back().seconds_search = search;
    reports.back().seconds_closing = closing;
    for (std::size_t i = 0; i < partial_.last().size(); ++i) {
      LevelNode& node = partial_.last()[i];
      node.leaf = node.sphere.radius + best->center_distances[i] <= options_.refinement.allowed(node.sphere);
    }
    return true;
  }

  // One solution of a level. All of them are to be judged by the first one's unit.
  Candidate candidate(detail::LevelOptions& level_options, const Progress& progress) {
    Candidate result{partial_, 0, {}, {}};
    result.partial.add_level();
    const auto start = std::chrono::steady_clock::now();
    const Index trials = trials_for(level_options.balls, work_);
    LevelSolver solver(surface_, detail::samples_for(samples_, partial_, level_options.balls), result.partial.paths(),
                       level_options);
    level_options.cost.unit = solver.unit();
    solver.tighten();
    solver.search(trials, [&](std::string_view stage, double fraction) { return progress(stage, 0.4 * fraction); });
    solver.tighten();
    const auto middle = std::chrono::steady_clock::now();
    const double fineness = static_cast<double>(surface_.mesh().triangles.size()) / kFewTriangles;
    const double closed_trials = work_.closed_trials / std::max(1.0, fineness);
    detail::FinishOptions finish{
        work_.searching_rounds, static_cast<Index>(kSearchShare * trials),
        static_cast<Index>(closed_trials * static_cast<double>(solver.balls().size())),
        [&](std::string_view stage, double fraction) { return progress(stage, 0.4 + 0.6 * fraction); }};
    detail::finish_level(surface_, solver, result.partial, finish, result.report);
    result.objective = solver.cost();
    for (const detail::LevelBall& ball : solver.balls()) result.center_distances.push_back(ball.center_distance);
    result.report.balls = static_cast<Index>(solver.balls().size());
    result.report.seconds_search = std::chrono::duration<double>(middle - start).count();
    result.report.seconds_closing = std::chrono::duration<double>(std::chrono::steady_clock::now() - middle).count();
    return result;
  }

  const Surface& surface_;
  const TightenOptions& options_;
  const Progress& progress_;
  const Work work_;
  const Samples samples_;
  PartialTree partial_;
};

}  // namespace

TightenBuild tightened_tree(const Surface& surface, const MedialAxis& axis, const TightenOptions& options,
                            const Progress& progress) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (axis.size() == 0) throw InputError("the medial axis has no vertex: sample the surface more densely");
  return Tightener(surface, axis, options, progress).run();
}

}  // namespace orchard
