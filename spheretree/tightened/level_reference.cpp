#include "level_reference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "infinity.h"
#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/octree.h"

namespace orchard::detail {
namespace {

// Larger levels are not compared, because those of an octree are then many times as loose as the tree's.
constexpr Index kMostCompared = 4096;
// A surface meets at least about four of eight cubes.
constexpr int kLogOfGrowth = 2;

}  // namespace

std::vector<double> inaccuracies(const Surface& surface, std::span<const LevelNode> level) {
  std::vector<double> values(level.size());
  tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
    values[i] = inaccuracy(surface, level[i].sphere, {tolerance::kInaccuracy, 0}).upper;
  });
  return values;
}

LevelTightness tightness(std::span<const double> values) {
  return {std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()),
          *std::max_element(values.begin(), values.end())};
}

OctreeReference::OctreeReference(const Surface& surface, std::span<const Index> spheres)
    : surface_(surface), spheres_(spheres.begin(), spheres.end()) {
  // Builds it level by level, up to the first level that is too large for all levels of the tree.
  const Index most = std::min(spheres.back(), kMostCompared);
  for (Index depth = 1; depth <= static_cast<Index>(std::bit_width(most) / kLogOfGrowth + 1); ++depth) {
    octree_ = octree(surface, {.depth = depth});
    const auto in_last = static_cast<Index>(std::count_if(octree_.nodes.begin(), octree_.nodes.end(),
                                                          [&](const SphereNode& node) { return node.level == depth; }));
    if (in_last > most) break;
  }
  for (Index i = 0; i < octree_.nodes.size(); ++i)
    if (octree_.nodes[i].level == begins_.size()) begins_.push_back(i);
  begins_.push_back(static_cast<Index>(octree_.nodes.size()));
  measured_.resize(begins_.size() - 1);
}

std::span<const SphereNode> OctreeReference::nodes(Index level) const {
  return std::span(octree_.nodes).subspan(begins_[level], begins_[level + 1] - begins_[level]);
}

Index OctreeReference::deepest_within(Index balls) const {
  Index level = 0;
  while (level + 1 < measured_.size() && nodes(level + 1).size() <= balls) ++level;
  return level;
}

LevelTightness OctreeReference::bound(Index balls) {
  LevelTightness least{kInfinity, kInfinity};
  for (Index level = 1; level <= deepest_within(balls); ++level) {
    LevelTightness& own = measured_[level];
    if (own.max == 0) {
      Level balls_there;
      for (const SphereNode& node : nodes(level)) balls_there.push_back({node.sphere});
      own = tightness(inaccuracies(surface_, balls_there));
    }
    least = {std::min(least.mean, own.mean), std::min(least.max, own.max)};
  }
  return least;
}

PartialTree OctreeReference::levels(const PartialTree& root, Index level) const {
  PartialTree partial = root;
  Index above = 0;
  for (Index l = 1; l <= level; ++l) {
    const Index here = deepest_within(spheres_[l - 1]);
    partial.add_level();
    for (Index i = 0; i < nodes(here).size(); ++i) {
      Index ancestor = begins_[here] + i;
      for (Index up = here; up > above; --up) ancestor = octree_.nodes[ancestor].parent;
      const Sphere& cube = octree_.nodes[begins_[here] + i].sphere;
      partial.last().push_back({.sphere = cube, .parent = ancestor - begins_[above], .grown = false});
    }
    above = here;
  }
  return partial;
}

std::vector<LevelBall> OctreeReference::start(const PathRegions& regions, Index balls, Index max_children) const {
  std::vector<LevelBall> start;
  std::vector<Index> held, children(regions.size(), 0);
  for (const SphereNode& node : nodes(deepest_within(balls))) {
    LevelBall ball;
    ball.center = node.sphere.center;
    ball.radius = node.sphere.radius;
    std::size_t most = 0;
    for (Index r = 0; r < regions.size(); ++r) {
      if (children[r] >= max_children) continue;
      held.clear();
      regions.append_samples(r, 0, ball.center, ball.radius * ball.radius, held);
      if (held.size() > most) most = held.size(), ball.path_region = r;
    }
    if (most == 0) continue;
    ++children[ball.path_region];
    start.push_back(ball);
  }
  for (std::size_t i = 0; !start.empty() && start.size() < balls; ++i) {
    LevelBall spare = start[i];
    spare.radius = -1;
    start.push_back(spare);
  }
  return start;
}

}  // namespace orchard::detail
