#include "orchard/spheretree/redundancy.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <numeric>
#include <utility>

#include "orchard/covering/path_forest.h"

namespace orchard {
namespace {

// In R: a point that is farther than this outside all paths is uncovered, whatever the rounding.
constexpr double kBeyondDoubt = 1e-9;
constexpr std::size_t kTogether = 4;  // triangles that one task tests

using Triangles = std::vector<std::vector<Index>>;

// For each node, the triangles that touch every ball on its path.
Triangles touching_paths(const SphereTree& tree, const Surface& surface) {
  Triangles touching(tree.nodes.size());
  tbb::parallel_for(std::size_t{0}, tree.nodes.size(), [&](std::size_t i) {
    const Sphere& ball = tree.nodes[i].sphere;
    surface.triangles_near({ball.center, ball.radius * (1 + 1e-9)}, touching[i]);
  });
  std::vector<Index> near;
  for (Index i = 1; i < tree.nodes.size(); ++i) {
    near.swap(touching[i]);
    touching[i].clear();
    const auto& above = touching[tree.nodes[i].parent];
    std::set_intersection(above.begin(), above.end(), near.begin(), near.end(), std::back_inserter(touching[i]));
  }
  return touching;
}

// Removes nodes as long as the path rule stays certified. Only triangles that touch the path region of a removed leaf
// can become uncovered.
class Remover {
 public:
  // `touching`: the result of touching_paths().
  Remover(const SphereTree& tree, const Surface& surface, Triangles touching)
      : tree_(tree), surface_(surface), forest_(path_balls(tree)), touching_(std::move(touching)) {
    leaves_below_.assign(tree.nodes.size(), 0);
    for (Index i = static_cast<Index>(tree.nodes.size()); i-- > 0;) {
      if (tree.nodes[i].child_count == 0) leaves_below_[i] = 1;
      if (i > 0) leaves_below_[tree.nodes[i].parent] += leaves_below_[i];
    }
  }

  bool gone(Index node) const { return leaves_below_[node] == 0; }

  // Removes the node if the path rule is certified without it. Returns whether it was removed.
  bool remove(Index node) {
    const std::vector<Index> leaves = leaves_of(node);
    if (leaves.size() == leaves_below_[0]) return false;
    for (Index leaf : leaves) forest_.ball(leaf).leaf = false;
    if (!still_covered(leaves)) {
      for (Index leaf : leaves) forest_.ball(leaf).leaf = true;
      return false;
    }
    for (Index leaf : leaves)
      for (Index up = leaf; up != kNone; up = tree_.nodes[up].parent) --leaves_below_[up];
    return true;
  }

  // The tree of the nodes that are left, and the triangles that touch its paths.
  SphereTree rest(Triangles& touching) {
    SphereTree rest;
    touching.clear();
    rest.branching = tree_.branching;
    std::vector<Index> place(tree_.nodes.size(), kNone);
    for (Index i = 0; i < tree_.nodes.size(); ++i) {
      if (gone(i)) continue;
      SphereNode node = tree_.nodes[i];
      place[i] = static_cast<Index>(rest.nodes.size());
      node.first_child = kNone;
      node.child_count = 0;
      if (i > 0) {
        node.parent = place[node.parent];
        SphereNode& parent = rest.nodes[node.parent];
        if (parent.child_count++ == 0) parent.first_child = place[i];
      }
      rest.nodes.push_back(node);
      touching.push_back(std::move(touching_[i]));
    }
    return rest;
  }

 private:
  std::vector<Index> leaves_of(Index node) const {
    std::vector<Index> leaves, open{node};
    while (!open.empty()) {
      const Index next = open.back();
      open.pop_back();
      if (gone(next)) continue;
      const SphereNode& n = tree_.nodes[next];
      if (n.child_count == 0) leaves.push_back(next);
      for (Index k = 0; k < n.child_count; ++k) open.push_back(n.first_child + k);
    }
    return leaves;
  }

  // A quick test: most leaves are the only ones that hold the place of the surface nearest to their centre, so they
  // cannot be removed.
  bool surely_uncovered(const std::vector<Index>& leaves) const {
    const double beyond_doubt = kBeyondDoubt * surface_.bounding_radius();
    return std::any_of(leaves.begin(), leaves.end(), [&](Index leaf) {
      const Point& center = tree_.nodes[leaf].sphere.center;
      const auto& triangles = touching_[leaf];
      return std::any_of(triangles.begin(), triangles.end(), [&](Index triangle) {
        const auto [a, b, c] = surface_.corners(triangle);
        return !forest_.within(closest_point_of_triangle(center, a, b, c).position, beyond_doubt);
      });
    });
  }

  bool still_covered(const std::vector<Index>& leaves) {
    if (surely_uncovered(leaves)) return false;
    std::vector<Index> triangles;
    for (Index leaf : leaves) triangles.insert(triangles.end(), touching_[leaf].begin(), touching_[leaf].end());
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    std::atomic<bool> covered = true;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), kTogether), [&](const auto& range) {
      NearBalls& near = near_.local();
      for (std::size_t i = range.begin(); i != range.end() && covered; ++i) {
        const auto corners = surface_.corners(triangles[i]);
        forest_.gather(corners, near);
        if (!triangle_covered(corners, near.balls)) covered = false;
      }
    });
    return covered;
  }

  const SphereTree& tree_;
  const Surface& surface_;
  PathForest forest_;
  std::vector<Index> leaves_below_;  // those that are not removed
  Triangles touching_;
  tbb::enumerable_thread_specific<NearBalls> near_;
};

// The nodes of a level that are not removed, the loosest first.
std::vector<Index> loosest_first(const SphereTree& tree, const Surface& surface, Index level, const Remover& remover) {
  std::vector<Index> nodes;
  for (Index i = 0; i < tree.nodes.size(); ++i)
    if (tree.nodes[i].level == level && !remover.gone(i)) nodes.push_back(i);
  std::vector<double> looseness(tree.nodes.size(), 0);
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t k) {
    const Sphere& ball = tree.nodes[nodes[k]].sphere;
    looseness[nodes[k]] =
        ball.radius + (surface.solid() ? surface.signed_distance(ball.center) : surface.distance(ball.center));
  });
  std::stable_sort(nodes.begin(), nodes.end(), [&](Index a, Index b) { return looseness[a] > looseness[b]; });
  return nodes;
}

// The redundant nodes of one level by the dissertation's two criteria. If both find a node, the nodes that cover it are
// its parent's siblings, because these are not removed any more when its level is treated.
std::vector<RedundantNode> redundant_on(const SphereTree& tree, const Surface& surface, Index level,
                                        RedundancyReport& report) {
  const auto by_siblings = redundant_nodes(tree, surface, level, Coverers::siblings);
  const auto by_aunts = redundant_nodes(tree, surface, level, Coverers::aunts);
  report.by_siblings += static_cast<Index>(by_siblings.size());
  report.by_aunts += static_cast<Index>(by_aunts.size());
  std::vector<RedundantNode> all = by_aunts;
  all.insert(all.end(), by_siblings.begin(), by_siblings.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node == b.node; }),
            all.end());
  return all;
}

}  // namespace

RedundancyReport remove_redundant(SphereTree& tree, const Surface& surface, Selection selection,
                                  const Progress& progress) {
  RedundancyReport report;
  const Index depth = tree.depth();
  const auto before = static_cast<Index>(tree.nodes.size());
  Triangles touching = touching_paths(tree, surface);
  for (Index level = 1; level <= depth; ++level) {
    report_progress(progress, "removing redundant spheres", static_cast<double>(level - 1) / depth);
    Remover remover(tree, surface, std::move(touching));
    if (selection == Selection::exhaustive) {
      for (Index node : loosest_first(tree, surface, level, remover)) remover.remove(node);
    } else {
      const auto redundant = redundant_on(tree, surface, level, report);
      const auto selected =
          selection == Selection::independent ? independent_selection(redundant) : acyclic_selection(redundant);
      report.selected += static_cast<Index>(selected.size());
      for (Index node : selected)
        if (!remover.remove(node)) ++report.vetoed;
    }
    tree = remover.rest(touching);
  }
  report.removed = before - static_cast<Index>(tree.nodes.size());
  return report;
}

}  // namespace orchard
