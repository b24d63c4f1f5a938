#include "orchard/spheretree/merging.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "child_builder.h"
#include "merge_closing.h"
#include "merge_reallocation.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "sibling_balance.h"

namespace orchard {
namespace {

using detail::Child;
using detail::Family;
using detail::Portion;

constexpr int kReallocationRounds = 2;

class MergeTree {
 public:
  MergeTree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options)
      : surface_(surface),
        options_(options),
        maker_(surface, axis, options),
        margin_(tolerance::kCoverMargin * surface.bounding_radius()) {}

  MergeBuild run(const Progress& progress) {
    MergeReport report;
    start();
    for (Index level = 1; level <= options_.depth; ++level) {
      report_progress(progress, "merging", static_cast<double>(level - 1) / options_.depth);
      maker_.start_level(level);
      if (!add_level(level)) break;
      if (options_.closing == MergeClosing::growth) continue;
      report_progress(progress, "merging", (level - 0.7) / options_.depth);
      MergeReport::Level& row = report.levels.emplace_back();
      close(row);
      for (int round = 0; round < kReallocationRounds && reallocate_freed_budget(level, row); ++round) close(row);
      row.spheres = static_cast<Index>(nodes_of(level).size());
    }
    return {std::move(tree_), std::move(report)};
  }

 private:
  void start() {
    tree_.branching = options_.branching;
    const Sphere& ball = surface_.bounding_ball();
    tree_.nodes.push_back({.sphere = {ball.center, ball.radius + margin_}});
    portions_.push_back(maker_.whole());
  }

  std::vector<Index> nodes_of(Index level) const {
    std::vector<Index> nodes;
    for (Index i = 0; i < tree_.nodes.size(); ++i)
      if (tree_.nodes[i].level == level) nodes.push_back(i);
    return nodes;
  }

  // Adds a level. Returns whether any node of the level above has got children.
  bool add_level(Index level) {
    const std::vector<Index> parents = nodes_of(level - 1);
    std::vector<std::vector<Child>> families(parents.size());
    tbb::parallel_for(std::size_t{0}, parents.size(), [&](std::size_t i) {
      if (splits(parents[i])) families[i] = maker_.children_of(portions_[parents[i]], options_.branching);
      if (families[i].size() < 2) families[i].clear();
    });
    if (options_.closing == MergeClosing::refit) balance(parents, families);
    const std::size_t before = tree_.nodes.size();
    append(level, parents, std::move(families));
    return tree_.nodes.size() > before;
  }

  // Gives loose families more of the level's spheres than tight ones.
  void balance(const std::vector<Index>& parents, std::vector<std::vector<Child>>& families) const {
    std::vector<Family> loads(families.size());
    tbb::parallel_for(std::size_t{0}, families.size(), [&](std::size_t i) {
      loads[i] = {static_cast<Index>(families[i].size()), maker_.cost_of(families[i])};
    });
    const std::vector<Index> counts = detail::balanced_counts(loads, maker_.power(), options_.branching);
    std::vector<std::vector<Child>> balanced(families.size());
    std::vector<double> costs(families.size(), 0);
    tbb::parallel_for(std::size_t{0}, families.size(), [&](std::size_t i) {
      if (counts[i] != loads[i].spheres) balanced[i] = maker_.resized(portions_[parents[i]], families[i], counts[i]);
      costs[i] = counts[i] != loads[i].spheres ? maker_.cost_of(balanced[i]) : loads[i].cost;
    });
    double before = 0, after = 0;
    for (std::size_t i = 0; i < families.size(); ++i) before += loads[i].cost, after += costs[i];
    if (after >= before) return;
    for (std::size_t i = 0; i < families.size(); ++i)
      if (!balanced[i].empty()) families[i] = std::move(balanced[i]);
  }

  void append(Index level, const std::vector<Index>& parents, std::vector<std::vector<Child>> families) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (families[i].empty()) continue;
      tree_.nodes[parents[i]].first_child = static_cast<Index>(tree_.nodes.size());
      tree_.nodes[parents[i]].child_count = static_cast<Index>(families[i].size());
      tree_.branching = std::max(tree_.branching, tree_.nodes[parents[i]].child_count);
      for (Child& child : families[i]) {
        tree_.nodes.push_back({.sphere = child.sphere, .parent = parents[i], .level = level});
        portions_.push_back(std::move(child.portion));
      }
      portions_[parents[i]] = {};
    }
  }

  bool splits(Index node) const {
    const Sphere& ball = tree_.nodes[node].sphere;
    return portions_[node].held.size() >= 2 && wants_children(options_.refinement, surface_, ball) &&
           !maker_.tight(ball);
  }

  void close(MergeReport::Level& row) {
    std::vector<std::vector<Point>> held(portions_.size());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = std::move(portions_[i].held);
    const detail::ClosingReport closed = detail::close_by_refitting(tree_, surface_, held, maker_.power());
    for (std::size_t i = 0; i < held.size(); ++i) {
      portions_[i].points.resize(held[i].size(), kNone);
      portions_[i].held = std::move(held[i]);
    }
    if (row.rounds == 0) row.uncovered_regions = closed.uncovered_regions;
    row.rounds += closed.rounds;
    row.growth = std::max(row.growth, closed.growth);
  }

  // Removes redundant spheres of the last level and splits its loosest spheres instead, as many as their parents have
  // room for. Returns whether any was split.
  bool reallocate_freed_budget(Index level, MergeReport::Level& row) {
    const Index removed = detail::remove_redundant_nodes(tree_, surface_, portions_);
    row.removed += removed;
    const std::vector<Index> parents = nodes_of(level - 1);
    std::vector<std::vector<Child>> families = take_off(level, parents);
    Index split = 0;
    detail::split_loosest(maker_, options_.branching, families);
    for (std::size_t i = 0; i < parents.size(); ++i)
      split += static_cast<Index>(families[i].size()) - tree_.nodes[parents[i]].child_count;
    row.split += split;
    append(level, parents, std::move(families));
    return split > 0;
  }

  // Removes the last level from the tree and returns it.
  std::vector<std::vector<Child>> take_off(Index level, const std::vector<Index>& parents) {
    std::vector<std::vector<Child>> families(parents.size());
    for (std::size_t i = 0; i < parents.size(); ++i) {
      const SphereNode& parent = tree_.nodes[parents[i]];
      for (Index k = parent.first_child; k != kNone && k < parent.first_child + parent.child_count; ++k)
        families[i].push_back({tree_.nodes[k].sphere, std::move(portions_[k])});
    }
    std::erase_if(tree_.nodes, [&](const SphereNode& node) { return node.level == level; });
    portions_.resize(tree_.nodes.size());
    return families;
  }

  const Surface& surface_;
  const MergeOptions& options_;
  detail::ChildBuilder maker_;
  const double margin_;
  SphereTree tree_;
  std::vector<Portion> portions_;  // the portion of each node; empty once the node has children
};

}  // namespace

MergeBuild merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options,
                      const Progress& progress) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (axis.size() == 0) throw InputError("the medial axis has no vertex: sample the surface more densely");
  return MergeTree(surface, axis, options).run(progress);
}

}  // namespace orchard
