#include "orchard/spheretree/merging.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <queue>

#include "medial_parts.h"
#include "merge_closing.h"
#include "merger.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/redundancy.h"
#include "sibling_balance.h"
#include "sibling_fit.h"

namespace orchard {
namespace {

using detail::Family;
using detail::FittedBall;
using detail::MergedParts;
using detail::Parts;
using detail::PartScratch;

// Where fewer vertices than this for each child are left, their points are merged instead: many points on one sphere,
// as around the axis of a cylinder, are one vertex, which could not be split.
constexpr std::size_t kVerticesPerChild = 2;
constexpr std::size_t kPointsPerChild = 2;  // at least, or there are fewer children
// A sphere as tight as this, as a fraction of R, is left as it is.
constexpr double kTight = 1e-3;
// Of the looseness, in the sum over siblings that is to be low; by level. What is loose at the top is loose all the way
// down.
constexpr double kPowers[] = {3.5, 3, 3};
// How many merged spheres, for each one wanted, a fit of siblings starts with.
constexpr double kStarts[] = {1.5, 1};
constexpr int kSpendingRounds = 2;
constexpr double kSplitGain = 0.97;  // a split that leaves more of the looseness is not worth a sphere

// What a node answers for: surface points that it must hold.
struct Patch {
  std::vector<Point> held;
  std::vector<Index> points;    // of each: of the axis, or kNone for one that a closing added
  std::vector<Index> vertices;  // of the axis, ascending, where they are not simply those that touch a point

  std::vector<Index> axis_points() const {
    std::vector<Index> list;
    std::copy_if(points.begin(), points.end(), std::back_inserter(list), [](Index p) { return p != kNone; });
    std::sort(list.begin(), list.end());
    return list;
  }
};

struct Child {
  Sphere sphere;
  Patch patch;
};

class MergeTree {
 public:
  MergeTree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options)
      : surface_(surface),
        axis_(axis),
        options_(options),
        margin_(tolerance::kCoverMargin * surface.bounding_radius()),
        scratch_([&axis] {
          return PartScratch{std::vector<Index>(axis.size(), kNone), std::vector<char>(axis.points.size(), 0)};
        }) {
    vertices_of_.resize(axis.points.size());
    for (Index v = 0; v < axis.size(); ++v)
      for (Index p : axis.forming_points[v]) vertices_of_[p].push_back(v);
  }

  SphereTree run(const Progress& progress, MergeReport& report) {
    start();
    for (Index level = 1; level <= options_.depth; ++level) {
      report_progress(progress, "merging", static_cast<double>(level - 1) / options_.depth);
      power_ = kPowers[std::min<std::size_t>(level, std::size(kPowers)) - 1];
      if (!add_level(level)) break;
      if (options_.closing == MergeClosing::growth) continue;
      report_progress(progress, "merging", (level - 0.7) / options_.depth);
      MergeReport::Level& row = report.levels.emplace_back();
      close(row);
      for (int round = 0; round < kSpendingRounds && spend_freed_budget(level, row); ++round) close(row);
      row.spheres = static_cast<Index>(nodes_of(level).size());
    }
    return std::move(tree_);
  }

 private:
  void start() {
    tree_.branching = options_.branching;
    const Sphere& ball = surface_.bounding_ball();
    tree_.nodes.push_back({.sphere = {ball.center, ball.radius + margin_}});
    patches_.resize(1);
    for (Index i = 0; i < axis_.size(); ++i) patches_[0].vertices.push_back(i);
    for (Index p = 0; p < axis_.points.size(); ++p)
      if (!vertices_of_[p].empty()) add_point(p, patches_[0]);
  }

  void add_point(Index point, Patch& patch) const {
    patch.points.push_back(point);
    patch.held.push_back(axis_.points[point]);
  }

  std::vector<Index> nodes_of(Index level) const {
    std::vector<Index> nodes;
    for (Index i = 0; i < tree_.nodes.size(); ++i)
      if (tree_.nodes[i].level == level) nodes.push_back(i);
    return nodes;
  }

  double looseness(const Sphere& ball) const { return ball.radius + surface_.signed_distance(ball.center); }

  // Whether any node of the level above got children.
  bool add_level(Index level) {
    const std::vector<Index> parents = nodes_of(level - 1);
    std::vector<std::vector<Child>> families(parents.size());
    tbb::parallel_for(std::size_t{0}, parents.size(), [&](std::size_t i) {
      if (splits(parents[i])) families[i] = children_of(parents[i], options_.branching);
      if (families[i].size() < 2) families[i].clear();
    });
    if (options_.closing == MergeClosing::refit) balance(parents, families);
    const std::size_t before = tree_.nodes.size();
    append(level, parents, std::move(families));
    return tree_.nodes.size() > before;
  }

  // Looser families get more of the level's spheres than tighter ones.
  void balance(const std::vector<Index>& parents, std::vector<std::vector<Child>>& families) const {
    std::vector<Family> loads(families.size());
    tbb::parallel_for(std::size_t{0}, families.size(), [&](std::size_t i) {
      loads[i] = {static_cast<Index>(families[i].size()), cost_of(families[i])};
    });
    const std::vector<Index> counts = detail::balanced_counts(loads, power_, options_.branching);
    std::vector<std::vector<Child>> balanced(families.size());
    std::vector<double> costs(families.size(), 0);
    tbb::parallel_for(std::size_t{0}, families.size(), [&](std::size_t i) {
      if (counts[i] != loads[i].spheres) balanced[i] = resized(patches_[parents[i]], families[i], counts[i]);
      costs[i] = counts[i] != loads[i].spheres ? cost_of(balanced[i]) : loads[i].cost;
    });
    double before = 0, after = 0;
    for (std::size_t i = 0; i < families.size(); ++i) before += loads[i].cost, after += costs[i];
    if (after >= before) return;
    for (std::size_t i = 0; i < families.size(); ++i)
      if (!balanced[i].empty()) families[i] = std::move(balanced[i]);
  }

  double cost_of(const std::vector<Child>& family) const {
    double sum = 0;
    for (const Child& child : family)
      sum += std::pow(std::max(0.0, looseness(child.sphere)) / surface_.bounding_radius(), power_);
    return sum;
  }

  void append(Index level, const std::vector<Index>& parents, std::vector<std::vector<Child>> families) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (families[i].empty()) continue;
      tree_.nodes[parents[i]].first_child = static_cast<Index>(tree_.nodes.size());
      tree_.nodes[parents[i]].child_count = static_cast<Index>(families[i].size());
      tree_.branching = std::max(tree_.branching, tree_.nodes[parents[i]].child_count);
      for (Child& child : families[i]) {
        tree_.nodes.push_back({.sphere = child.sphere, .parent = parents[i], .level = level});
        patches_.push_back(std::move(child.patch));
      }
      patches_[parents[i]] = {};
    }
  }

  bool splits(Index node) const {
    const Sphere& ball = tree_.nodes[node].sphere;
    return patches_[node].held.size() >= 2 && wants_children(options_.refinement, surface_, ball) &&
           looseness(ball) > kTight * surface_.bounding_radius();
  }

  std::vector<Child> children_of(Index node, Index most) const {
    const Patch& patch = patches_[node];
    const std::vector<Index> points = patch.axis_points();
    if (points.size() < 2) return {};
    const std::vector<Index> vertices = patch.vertices.empty() ? touching(points) : patch.vertices;
    const std::size_t target = std::clamp<std::size_t>(points.size() / kPointsPerChild, 2, most);
    Parts parts = detail::vertex_parts(axis_, vertices, points, scratch_.local());
    const bool by_points = parts.spheres.size() < kVerticesPerChild * target;
    if (by_points) parts = detail::point_parts(axis_, points);
    if (options_.closing == MergeClosing::refit) return fitted(patch, parts, target);
    const auto groups = detail::merge_parts(axis_, parts, {&target, 1})[0];
    return as_merged(parts, groups, by_points ? std::vector<Index>{} : vertices);
  }

  // The vertices that touch any of the points.
  std::vector<Index> touching(const std::vector<Index>& points) const {
    std::vector<Index> vertices;
    for (Index p : points) vertices.insert(vertices.end(), vertices_of_[p].begin(), vertices_of_[p].end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  // Each sphere around all points of its parts, which others may have as well.
  std::vector<Child> as_merged(const Parts& parts, const std::vector<MergedParts>& groups,
                               const std::vector<Index>& vertices) const {
    std::vector<Child> children;
    for (const MergedParts& group : groups) {
      Child child{group.sphere, {}};
      std::vector<Index> points;
      for (Index part : group.parts) {
        points.insert(points.end(), parts.points[part].begin(), parts.points[part].end());
        if (!vertices.empty()) child.patch.vertices.push_back(vertices[part]);
      }
      std::sort(points.begin(), points.end());
      points.erase(std::unique(points.begin(), points.end()), points.end());
      for (Index p : points) add_point(p, child.patch);
      detail::shrink_around(child.patch.held, child.sphere);
      child.sphere.radius += margin_;
      children.push_back(std::move(child));
    }
    return children;
  }

  // From more spheres than wanted as well: which of them are best to do without, their fit tells better than the
  // merging.
  std::vector<Child> fitted(const Patch& patch, const Parts& parts, std::size_t wanted) const {
    std::vector<std::size_t> targets;
    for (const double more : kStarts) targets.push_back(static_cast<std::size_t>(more * static_cast<double>(wanted)));
    std::vector<std::vector<FittedBall>> starts;
    for (const auto& groups : detail::merge_parts(axis_, parts, targets)) {
      starts.emplace_back();
      for (const MergedParts& group : groups) starts.back().push_back(start_at(group.sphere.center));
    }
    return shared_out(patch, starts, wanted);
  }

  // As many as wanted, from a family of another size.
  std::vector<Child> resized(const Patch& patch, const std::vector<Child>& family, Index wanted) const {
    std::vector<FittedBall> start;
    for (const Child& child : family) start.push_back(start_at(child.sphere.center));
    return shared_out(patch, {&start, 1}, wanted);
  }

  FittedBall start_at(const Point& center) const { return {center, 0, surface_.signed_distance(center)}; }

  std::vector<Child> shared_out(const Patch& patch, std::span<const std::vector<FittedBall>> starts,
                                std::size_t wanted) const {
    const detail::Siblings siblings =
        detail::fit_siblings(surface_, patch.held, starts, wanted, power_, tree_.nodes.size() == 1);
    std::vector<Child> children;
    for (const FittedBall& ball : siblings.balls) children.push_back({{ball.center, ball.radius + margin_}, {}});
    for (std::size_t i = 0; i < siblings.owner.size(); ++i) {
      Patch& own = children[siblings.owner[i]].patch;
      own.held.push_back(patch.held[i]);
      own.points.push_back(patch.points[i]);
    }
    return children;
  }

  void close(MergeReport::Level& row) {
    std::vector<std::vector<Point>> held(patches_.size());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = std::move(patches_[i].held);
    const detail::ClosingReport closed = detail::close_level(tree_, surface_, held, power_);
    for (std::size_t i = 0; i < held.size(); ++i) {
      patches_[i].points.resize(held[i].size(), kNone);
      patches_[i].held = std::move(held[i]);
    }
    if (row.rounds == 0) row.spots = closed.spots;
    row.rounds += closed.rounds;
    row.growth = std::max(row.growth, closed.growth);
  }

  // Takes out what the last level can do without and splits its loosest spheres instead, as many as their parents have
  // room for. Whether anything was split.
  bool spend_freed_budget(Index level, MergeReport::Level& row) {
    const Index removed = remove_redundant_nodes(level);
    row.removed += removed;
    const std::vector<Index> parents = nodes_of(level - 1);
    std::vector<std::vector<Child>> families = take_off(level, parents);
    Index split = 0;
    fill(families);
    for (std::size_t i = 0; i < parents.size(); ++i)
      split += static_cast<Index>(families[i].size()) - tree_.nodes[parents[i]].child_count;
    row.split += split;
    append(level, parents, std::move(families));
    return split > 0;
  }

  // Points of a node that is gone go to the tightest leaf of those that they have a path to.
  Index remove_redundant_nodes(Index level) {
    const std::vector<SphereNode> before = std::move(tree_.nodes);
    tree_.nodes = before;
    const Index removed = remove_redundant(tree_, surface_).removed;
    if (removed == 0) return 0;
    std::vector<Patch> patches(tree_.nodes.size()), homeless;
    for (Index i = 0, k = 0; i < before.size(); ++i) {
      const bool kept = k < tree_.nodes.size() && before[i].level == tree_.nodes[k].level &&
                        before[i].sphere.center == tree_.nodes[k].sphere.center &&
                        before[i].sphere.radius == tree_.nodes[k].sphere.radius;
      if (kept) {
        patches[k++] = std::move(patches_[i]);
      } else if (before[i].level == level) {
        homeless.push_back(std::move(patches_[i]));
      }
    }
    patches_ = std::move(patches);
    for (const Patch& patch : homeless)
      for (std::size_t i = 0; i < patch.held.size(); ++i) {
        Holder best;
        find_holder(0, patch.held[i], best);
        if (best.node == kNone) continue;
        patches_[best.node].held.push_back(patch.held[i]);
        patches_[best.node].points.push_back(patch.points[i]);
      }
    return removed;
  }

  struct Holder {
    Index node = kNone;
    double radius = std::numeric_limits<double>::infinity();
  };
  void find_holder(Index index, const Point& point, Holder& best) const {
    const SphereNode& node = tree_.nodes[index];
    if ((point - node.sphere.center).squaredNorm() > node.sphere.radius * node.sphere.radius) return;
    if (node.child_count == 0 && node.sphere.radius < best.radius) best = {index, node.sphere.radius};
    for (Index k = 0; k < node.child_count; ++k) find_holder(node.first_child + k, point, best);
  }

  // The last level, off the tree.
  std::vector<std::vector<Child>> take_off(Index level, const std::vector<Index>& parents) {
    std::vector<std::vector<Child>> families(parents.size());
    for (std::size_t i = 0; i < parents.size(); ++i) {
      const SphereNode& parent = tree_.nodes[parents[i]];
      for (Index k = parent.first_child; k != kNone && k < parent.first_child + parent.child_count; ++k)
        families[i].push_back({tree_.nodes[k].sphere, std::move(patches_[k])});
    }
    std::erase_if(tree_.nodes, [&](const SphereNode& node) { return node.level == level; });
    patches_.resize(tree_.nodes.size());
    return families;
  }

  // Splits the loosest spheres, as long as the level has room.
  void fill(std::vector<std::vector<Child>>& families) const {
    struct Place {
      double loose;
      std::size_t family, child;
      bool operator<(const Place& other) const {
        if (loose != other.loose) return loose < other.loose;
        return family != other.family ? family > other.family : child > other.child;
      }
    };
    std::priority_queue<Place> loosest;
    Index room = 0;
    for (std::size_t i = 0; i < families.size(); ++i) {
      if (!families[i].empty()) room += options_.branching;
      for (std::size_t k = 0; k < families[i].size(); ++k) {
        loosest.push({looseness(families[i][k].sphere), i, k});
        --room;
      }
    }
    const std::size_t most = std::min<std::size_t>(64, 2 * options_.branching);
    for (; room > 0 && !loosest.empty();) {
      const Place at = loosest.top();
      loosest.pop();
      if (at.loose <= kTight * surface_.bounding_radius()) return;
      std::vector<Child>& family = families[at.family];
      if (family.size() >= most) continue;
      std::vector<Child> two = halves(family[at.child]);
      if (two.size() < 2) continue;
      const double first = looseness(two[0].sphere), second = looseness(two[1].sphere);
      if (std::max(first, second) > kSplitGain * at.loose) continue;
      family[at.child] = std::move(two[0]);
      family.push_back(std::move(two[1]));
      loosest.push({first, at.family, at.child});
      loosest.push({second, at.family, family.size() - 1});
      --room;
    }
  }

  std::vector<Child> halves(const Child& child) const {
    const std::vector<Point>& held = child.patch.held;
    if (held.size() < 2 * kPointsPerChild) return {};
    const Point& center = child.sphere.center;
    const Point& far = *std::max_element(held.begin(), held.end(), [&](const Point& p, const Point& q) {
      return (p - center).squaredNorm() < (q - center).squaredNorm();
    });
    const std::vector<FittedBall> two{start_at(center), start_at(far + 0.3 * (center - far))};
    return shared_out(child.patch, {&two, 1}, 2);
  }

  const Surface& surface_;
  const MedialAxis& axis_;
  const MergeOptions& options_;
  const double margin_;
  mutable tbb::enumerable_thread_specific<PartScratch> scratch_;
  std::vector<std::vector<Index>> vertices_of_;  // each point
  SphereTree tree_;
  double power_ = kPowers[0];
  std::vector<Patch> patches_;  // of each node; empty once it has children
};

}  // namespace

SphereTree merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options,
                      const Progress& progress, MergeReport* report) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (axis.size() == 0) throw InputError("the medial axis has no vertex: sample the surface more densely");
  MergeReport unused;
  return MergeTree(surface, axis, options).run(progress, report ? *report : unused);
}

}  // namespace orchard
