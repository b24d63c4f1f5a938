#include "orchard/spheretree/tightened.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "level_solver.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/cover.h"
#include "spots.h"

namespace orchard {
namespace {

using detail::LevelBall;
using detail::LevelCost;
using detail::LevelSolver;
using detail::Samples;

// What every ball grows by once its level is closed, as a fraction of R: the levels below find their samples well
// inside some region, and gaps smaller than that need no more work.
constexpr double kGrowth = 2e-5;
// Gaps below this part of it are left to it.
constexpr double kSmallGap = 0.4;
// A level is as coarse as its samples allow.
constexpr Index kSamplesPerBall = 8;
// Large balls need few samples for each to be judged by.
constexpr Index kEnoughSamplesPerBall = 500;
constexpr int kClosingRounds = 24;
constexpr int kTighteningRounds = 4;  // of them, after those that search

struct Work {
  double trials;       // of the neighbourhood search, as a multiple of the standard number
  int polishing;       // closing rounds that search again
  Index restarts = 1;  // of the first level
};
Work work_for(Effort effort) {
  switch (effort) {
    case Effort::low:
      return {0.25, 2, 1};
    case Effort::standard:
      return {1, 8, 2};
    case Effort::high:
      return {10, 12, 4};
  }
  return {1, 8, 2};
}
constexpr double kPolishShare = 0.1;  // of the trials, in each polishing round
Index trials_for(Index balls, const Work& work) { return static_cast<Index>(work.trials * (300 + 14.0 * balls)); }

// High powers at the top: what is loose there is loose all the way down.
LevelCost cost_for(Objective objective, Index level, Index depth) {
  switch (objective) {
    case Objective::balanced:
      return {level == 1 ? 6.0 : level < depth ? 4.0 : 3.0, 0};
    case Objective::maximum:
      return {10, 0};
    case Objective::mean:
      return {level < depth ? 3.0 : 1.5, 0};
    case Objective::volume:
      return {2, 2};
  }
  return {};
}

struct Node {
  Sphere sphere;
  Index parent = kNone;  // on the level above
  bool leaf = false;     // needs no children
};
using Level = std::vector<Node>;

class Tightener {
 public:
  Tightener(const Surface& surface, const MedialAxis& axis, const TightenOptions& options, const Progress& progress)
      : surface_(surface),
        options_(options),
        progress_(progress),
        work_(work_for(options.effort)),
        radius_(surface.bounding_radius()) {
    make_samples(axis);
  }

  SphereTree run(TightenReport& report) {
    levels_.resize(1);
    const Sphere& ball = surface_.bounding_ball();
    levels_[0].push_back({{ball.center, ball.radius + tolerance::kCoverMargin * radius_}});
    for (Index level = 1; level <= options_.depth; ++level)
      if (!build_level(level, report.levels)) break;
    return tree();
  }

 private:
  // The axis's surface points, each with the centre of the largest medial ball that touches it, and the mesh's corners
  // if they are not too many.
  void make_samples(const MedialAxis& axis) {
    std::vector<Index> pole(axis.points.size(), kNone);
    for (Index v = 0; v < axis.size(); ++v)
      for (Index p : axis.forming_points[v])
        if (pole[p] == kNone || axis.radii[v] > axis.radii[pole[p]]) pole[p] = v;
    for (Index p = 0; p < axis.points.size(); ++p) {
      samples_.points.push_back(axis.points[p]);
      samples_.starts.push_back(pole[p] == kNone ? axis.points[p] : axis.centers[pole[p]]);
    }
    if (surface_.mesh().vertices.size() > axis.points.size()) return;
    for (Index v = 0; v < surface_.mesh().vertices.size(); ++v) {
      if (surface_.triangles_around(v).empty()) continue;
      samples_.points.push_back(surface_.mesh().vertices[v]);
      samples_.starts.push_back(surface_.mesh().vertices[v]);
    }
  }

  bool build_level(Index level, std::vector<TightenReport::Level>& reports) {
    const Level& above = levels_.back();
    Index refined = 0;
    for (const Node& node : above) refined += !node.leaf;
    const auto most = static_cast<double>(samples_.size() / kSamplesPerBall);
    const double wanted = std::min(most, static_cast<double>(options_.branching) * refined);
    if (refined == 0 || (wanted <= refined && level > 1)) return false;
    detail::LevelOptions level_options;
    level_options.balls = static_cast<Index>(wanted);
    level_options.most_children = std::min<Index>(64, 2 * options_.branching);
    level_options.cost = cost_for(options_.objective, level, options_.depth);
    level_options.level = level;

    TightenReport::Level& report = reports.emplace_back();
    const auto start = std::chrono::steady_clock::now();
    LevelSolver solver = best_start(level_options);
    const auto middle = std::chrono::steady_clock::now();
    levels_.emplace_back();
    close(solver, report);
    finish_level(solver, report);
    report.balls = static_cast<Index>(levels_.back().size());
    report.seconds_search = std::chrono::duration<double>(middle - start).count();
    report.seconds_closing = std::chrono::duration<double>(std::chrono::steady_clock::now() - middle).count();
    return true;
  }

  LevelSolver best_start(detail::LevelOptions level_options) {
    std::optional<LevelSolver> best;
    const Index restarts = level_options.level == 1 ? work_.restarts : 1;
    for (Index restart = 0; restart < restarts; ++restart) {
      level_options.seed = options_.seed + 0x100000001u * restart;
      LevelSolver solver(surface_, samples_for(level_options.balls), paths(), level_options);
      solver.start();
      solver.tighten();
      solver.search(trials_for(level_options.balls, work_), stage_progress(level_options.level));
      solver.tighten();
      if (!best || solver.objective() < best->objective()) best.emplace(std::move(solver));
    }
    return std::move(*best);
  }

  Progress stage_progress(Index level) const {
    if (!progress_) return {};
    return [this, level](std::string_view, double fraction) {
      return progress_("tightening", (level - 1 + 0.5 * fraction) / options_.depth);
    };
  }

  // Every k-th sample of those that no leaf holds.
  Samples samples_for(Index balls) const {
    const Index enough = std::max<Index>(2000, kEnoughSamplesPerBall * balls);
    const Index stride = std::max<Index>(1, samples_.size() / enough);
    Samples chosen;
    for (Index s = 0; s < samples_.size(); s += stride) {
      if (in_leaf(samples_.points[s])) continue;
      chosen.points.push_back(samples_.points[s]);
      chosen.starts.push_back(samples_.starts[s]);
    }
    return chosen;
  }

  bool in_leaf(const Point& point) const {
    for (Index level = 0; level < levels_.size(); ++level)
      for (Index i = 0; i < levels_[level].size(); ++i)
        if (levels_[level][i].leaf && holds(path(level, i), point)) return true;
    return false;
  }
  static bool holds(const std::vector<Sphere>& path, const Point& point) {
    return std::all_of(path.rbegin(), path.rend(), [&](const Sphere& ball) {
      return (point - ball.center).squaredNorm() <= ball.radius * ball.radius;
    });
  }

  // The balls from the root to a node, without half of their last growth.
  std::vector<Sphere> path(Index level, Index node) const {
    std::vector<Sphere> balls;
    for (;; --level) {
      const Node& n = levels_[level][node];
      balls.push_back({n.sphere.center, n.sphere.radius - (level == 0 ? 0 : kGrowth / 2 * radius_)});
      if (level == 0) break;
      node = n.parent;
    }
    std::reverse(balls.begin(), balls.end());
    return balls;
  }

  // Of the nodes on the last level that need children; a region of the solver is one of these.
  std::vector<std::vector<Sphere>> paths() {
    std::vector<std::vector<Sphere>> result;
    parents_.clear();
    const auto level = static_cast<Index>(levels_.size() - 1);
    for (Index i = 0; i < levels_[level].size(); ++i) {
      if (levels_[level][i].leaf) continue;
      parents_.push_back(i);
      result.push_back(path(level, i));
    }
    return result;
  }

  void take_balls(const LevelSolver& solver) {
    Level& level = levels_.back();
    level.clear();
    for (const LevelBall& ball : solver.balls())
      level.push_back({{ball.center, ball.radius + tolerance::kCoverMargin * radius_}, parents_[ball.region]});
  }

  // Finds what no path region is certain to hold and has the balls take it in, until only gaps are left that the last
  // growth fills. While there is work left, the search goes on with what was found among its samples.
  void close(LevelSolver& solver, TightenReport::Level& report) {
    std::vector<Index> triangles(surface_.mesh().triangles.size());
    for (Index i = 0; i < triangles.size(); ++i) triangles[i] = i;
    for (int round = 0; round < kClosingRounds; ++round) {
      report_progress(progress_, "tightening",
                      (static_cast<double>(levels_.size()) - 1.5 + 0.5 * round / kClosingRounds) / options_.depth);
      take_balls(solver);
      const std::vector<PathBall> balls = path_balls(tree());
      const Coverage coverage = surface_coverage(surface_, triangles, balls);
      const auto spots = large_spots(coverage, balls);
      if (round == 0) report.gaps = static_cast<Index>(spots.size());
      if (spots.empty()) return;
      ++report.closing_rounds;
      const std::vector<LevelBall> before = solver.balls();
      const bool polish = round < work_.polishing;
      solver.take_in(spots, !polish);
      if (round < work_.polishing + kTighteningRounds) solver.tighten();
      if (polish) {
        solver.search(static_cast<Index>(kPolishShare * trials_for(static_cast<Index>(before.size()), work_)));
        solver.tighten();
      }
      triangles = to_recheck(coverage, before, solver.balls());
    }
    take_balls(solver);
  }

  std::vector<detail::Spot> large_spots(const Coverage& coverage, std::span<const PathBall> balls) const {
    auto spots = detail::find_spots(surface_, coverage, balls, tolerance::kCoverMargin * radius_);
    std::erase_if(spots, [&](const detail::Spot& spot) { return spot.depth <= kSmallGap * kGrowth * radius_; });
    return spots;
  }

  // Uncovered triangles, and those that a ball may have let go.
  std::vector<Index> to_recheck(const Coverage& coverage, const std::vector<LevelBall>& before,
                                const std::vector<LevelBall>& after) const {
    std::vector<char> marked(surface_.mesh().triangles.size(), 0);
    for (const UncoveredTriangle& uncovered : coverage.uncovered) marked[uncovered.triangle] = 1;
    std::vector<Index> near;
    for (std::size_t b = 0; b < before.size(); ++b) {
      if (before[b].center == after[b].center && before[b].radius <= after[b].radius &&
          before[b].region == after[b].region)
        continue;
      surface_.triangles_near({before[b].center, before[b].radius + tolerance::kCoverMargin * radius_}, near);
      for (Index triangle : near) marked[triangle] = 1;
    }
    std::vector<Index> triangles;
    for (Index i = 0; i < marked.size(); ++i)
      if (marked[i]) triangles.push_back(i);
    return triangles;
  }

  // Settles what is left by growing, then gives every ball its last growth and decides which are accurate enough.
  void finish_level(const LevelSolver& solver, TightenReport::Level& report) {
    take_balls(solver);
    for (Node& node : levels_.back()) node.sphere.radius += 0.5 * kGrowth * radius_;
    SphereTree closed = tree();
    report.grown = cover(closed, surface_, {}).largest_growth;
    for (Index level = 0; level < levels_.size(); ++level)
      for (Index i = 0; i < levels_[level].size(); ++i)
        if (places_[level][i] != kNone) levels_[level][i].sphere.radius = closed.nodes[places_[level][i]].sphere.radius;
    for (std::size_t i = 0; i < levels_.back().size(); ++i) {
      Node& node = levels_.back()[i];
      node.sphere.radius += 0.5 * kGrowth * radius_;
      node.leaf = node.sphere.radius + solver.balls()[i].depth <= options_.refinement.allowed(node.sphere);
    }
  }

  // The levels so far as a tree. A node above the last level that got no children, and was to have some, holds nothing
  // that others do not: it is left out.
  SphereTree tree() {
    const auto depth = levels_.size();
    std::vector<std::vector<std::vector<Index>>> children(depth);
    std::vector<std::vector<char>> kept(depth);
    for (std::size_t level = depth; level-- > 0;) {
      children[level].resize(levels_[level].size());
      kept[level].assign(levels_[level].size(), 0);
      for (std::size_t i = 0; i < levels_[level].size(); ++i)
        kept[level][i] = levels_[level][i].leaf || level + 1 == depth;
      if (level + 1 == depth) continue;
      for (Index i = 0; i < levels_[level + 1].size(); ++i) {
        if (!kept[level + 1][i]) continue;
        children[level][levels_[level + 1][i].parent].push_back(i);
        kept[level][levels_[level + 1][i].parent] = 1;
      }
    }
    SphereTree result;
    result.branching = options_.branching;
    places_.assign(depth, {});
    for (std::size_t level = 0; level < depth; ++level) places_[level].assign(levels_[level].size(), kNone);
    result.nodes.push_back({.sphere = levels_[0][0].sphere});
    places_[0][0] = 0;
    std::vector<Index> row{0};  // of the level, in the tree's order
    for (std::size_t level = 0; level + 1 < depth; ++level) {
      std::vector<Index> next;
      for (Index i : row) {
        const Index at = places_[level][i];
        const auto& list = children[level][i];
        if (list.empty()) continue;
        result.nodes[at].first_child = static_cast<Index>(result.nodes.size());
        result.nodes[at].child_count = static_cast<Index>(list.size());
        result.branching = std::max(result.branching, result.nodes[at].child_count);
        for (Index child : list) {
          places_[level + 1][child] = static_cast<Index>(result.nodes.size());
          result.nodes.push_back(
              {.sphere = levels_[level + 1][child].sphere, .parent = at, .level = static_cast<Index>(level + 1)});
          next.push_back(child);
        }
      }
      row = std::move(next);
    }
    return result;
  }

  const Surface& surface_;
  const TightenOptions& options_;
  const Progress& progress_;
  const Work work_;
  const double radius_;
  Samples samples_;
  std::vector<Level> levels_;
  std::vector<Index> parents_;              // on the last level but one, of each region of the solver
  std::vector<std::vector<Index>> places_;  // in the tree made last, of each node; kNone: left out
};

}  // namespace

SphereTree tightened_tree(const Surface& surface, const MedialAxis& axis, const TightenOptions& options,
                          const Progress& progress, TightenReport* report) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (axis.size() == 0) throw InputError("the medial axis has no vertex: sample the surface more densely");
  TightenReport unused;
  return Tightener(surface, axis, options, progress).run(report ? *report : unused);
}

}  // namespace orchard
