#include "orchard/spheretree/annealing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "octants.h"
#include "orchard/covering/incremental_cover.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/redundancy.h"
#include "sibling_schedule.h"

namespace orchard {
namespace {

class Annealer {
 public:
  Annealer(const Surface& surface, const AnnealingOptions& options)
      : surface_(surface), options_(options), margin_(tolerance::kCoverMargin * surface.bounding_radius()) {}

  AnnealingBuild build(const Progress& progress) {
    tree_.branching = options_.branching;
    tree_.nodes.push_back({.sphere = surface_.bounding_ball()});
    tree_.nodes[0].sphere.radius += margin_;
    for (Index level = 1; level <= options_.depth; ++level) {
      const auto above = static_cast<Index>(tree_.nodes.size());
      for (Index node = 0; node < above; ++node)
        if (tree_.nodes[node].level + 1 == level && wants_children(options_.refinement, surface_, ball(node)))
          add_children(node);
      if (tree_.nodes.size() == above) break;
      anneal_level(level, options_.depth, KeepBest::no, progress);
      report_.redundant += remove_redundant(tree_, surface_, options_.redundancy).removed;
    }
    return {std::move(tree_), report_};
  }

  AnnealingReport tighten(SphereTree& tree, const Progress& progress) {
    tree_ = std::move(tree);
    const Index depth = tree_.nodes.back().level;
    for (Index level = 1; level <= depth; ++level) anneal_level(level, depth, KeepBest::yes, progress);
    tree = std::move(tree_);
    return report_;
  }

 private:
  using KeepBest = detail::KeepBest;

  const Sphere& ball(Index node) const { return tree_.nodes[node].sphere; }

  // Adds the octants of the bounding box, or of the cube around the parent, that meet triangles inside the balls above.
  void add_children(Index parent) {
    Octant whole{surface_.bounding_box(), triangles_on_path(parent), parent};
    if (parent != 0) {
      const Vector half = Vector::Constant(ball(parent).radius);
      whole.box = Box(ball(parent).center - half, ball(parent).center + half);
    }
    const auto octants = occupied_parts(surface_, whole, options_.branching);
    tree_.nodes[parent].first_child = static_cast<Index>(tree_.nodes.size());
    tree_.nodes[parent].child_count = static_cast<Index>(octants.size());
    const Index level = tree_.nodes[parent].level + 1;
    for (const Octant& octant : octants)
      tree_.nodes.push_back({.sphere = {octant.box.center(), octant.box.diagonal().norm() / 2 + margin_},
                             .parent = parent,
                             .level = level});
    if (octants.empty()) tree_.nodes[parent].first_child = kNone;
  }

  std::vector<Index> triangles_on_path(Index node) const {
    std::vector<Index> triangles;
    // a margin for rounding errors; a triangle too many does no harm
    constexpr double kRoom = 1 + 1e-9;
    surface_.triangles_near({ball(node).center, kRoom * ball(node).radius}, triangles);
    for (Index above = tree_.nodes[node].parent; above != kNone; above = tree_.nodes[above].parent)
      std::erase_if(triangles, [&](Index triangle) {
        const auto [a, b, c] = surface_.corners(triangle);
        return closest_point_of_triangle(ball(above).center, a, b, c).distance > kRoom * ball(above).radius;
      });
    return triangles;
  }

  // If no triangle meets both of two parents, their children cannot uncover what the other's children cover. Such
  // parents are annealed at the same time, each with a cover of its own triangles.
  void anneal_level(Index level, Index depth, KeepBest keep, const Progress& progress) {
    std::vector<Index> parents;
    for (Index node = 0; node < tree_.nodes.size(); ++node)
      if (tree_.nodes[node].level + 1 == level && tree_.nodes[node].child_count > 0) parents.push_back(node);
    std::vector<std::vector<Index>> triangles(parents.size());
    tbb::parallel_for(std::size_t{0}, parents.size(),
                      [&](std::size_t i) { triangles[i] = triangles_on_path(parents[i]); });
    std::vector<AnnealingReport> reports(parents.size());
    std::size_t done = 0;
    for (const std::vector<std::size_t>& group : apart(triangles)) {
      report_progress(progress, "annealing",
                      (level - 1 + static_cast<double>(done) / static_cast<double>(parents.size())) / depth);
      const std::vector<PathBall> balls = path_balls(tree_);
      tbb::parallel_for(std::size_t{0}, group.size(), [&](std::size_t k) {
        const std::size_t i = group[k];
        IncrementalCover cover(surface_, triangles[i], balls);
        detail::SiblingSchedule(tree_, parents[i], surface_, options_, cover, reports[i])
            .run(level == 1 ? options_.iterations_first : options_.iterations, keep);
      });
      done += group.size();
    }
    for (const AnnealingReport& one : reports) {
      report_.changes += one.changes;
      report_.uncovering += one.uncovering;
      report_.accepted += one.accepted;
    }
  }

  // Divides lists of triangles into groups in which no triangle is in two lists. Each list, in order, goes into the
  // first group where that is so.
  std::vector<std::vector<std::size_t>> apart(const std::vector<std::vector<Index>>& lists) const {
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::vector<char>> taken;  // the triangles that each group contains
    for (std::size_t i = 0; i < lists.size(); ++i) {
      std::size_t group = 0;
      const auto clash = [&](Index triangle) { return taken[group][triangle] != 0; };
      while (group < groups.size() && std::any_of(lists[i].begin(), lists[i].end(), clash)) ++group;
      if (group == groups.size()) {
        groups.emplace_back();
        taken.emplace_back(surface_.mesh().triangles.size(), 0);
      }
      groups[group].push_back(i);
      for (Index triangle : lists[i]) taken[group][triangle] = 1;
    }
    return groups;
  }

  const Surface& surface_;
  const AnnealingOptions& options_;
  const double margin_;
  SphereTree tree_;
  AnnealingReport report_;
};

void check(const AnnealingOptions& o) {
  if (o.branching < 2 || o.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (!(o.min_scale > 0) || !(o.min_scale <= o.max_scale) || !(o.move >= 0))
    throw InputError("annealing: moves and scales must be above 0, with the smallest scale first");
  if (!(o.cooling > 0) || !(o.cooling < 1) || !(o.first_acceptance > 0) || !(o.first_acceptance < 1))
    throw InputError("annealing: the cooling and the first acceptance must lie between 0 and 1");
  if (o.max_accepted < 1 || o.max_rejected < 1 || o.max_uncovering < 1)
    throw InputError("annealing: there must be at least one change at each temperature");
  if (o.first_trials < 1) throw InputError("annealing: there must be at least one trial for the first temperature");
}

}  // namespace

AnnealingOptions annealing_options(Effort effort) {
  if (effort == Effort::high) return {};
  const bool low = effort == Effort::low;
  AnnealingOptions options;
  options.max_accepted = options.max_rejected = low ? 30 : 60;
  options.iterations_first = low ? 40 : 80;
  options.iterations = low ? 20 : 30;
  options.cooling = low ? 0.8 : 0.85;
  return options;
}

AnnealingBuild annealed_tree(const Surface& surface, const AnnealingOptions& options, const Progress& progress) {
  check(options);
  return Annealer(surface, options).build(progress);
}

AnnealingReport anneal_tree(SphereTree& tree, const Surface& surface, const AnnealingOptions& options,
                            const Progress& progress) {
  check(options);
  if (!surface.solid())
    throw InputError("annealing needs a solid: " + surface.report().faults() + "; repair the mesh first");
  return Annealer(surface, options).tighten(tree, progress);
}

}  // namespace orchard
