#include "orchard/spheretree/merging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <unordered_set>
#include <utility>

#include "orchard/geometry/error.h"
#include "orchard/geometry/min_ball.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

// Directions spread over the sphere by the golden angle: a group's extreme points along them stand for all its points.
constexpr int kCoreDirections = 40;
const std::array<Vector, kCoreDirections>& core_directions() {
  static const std::array<Vector, kCoreDirections> directions = [] {
    std::array<Vector, kCoreDirections> list;
    for (int i = 0; i < kCoreDirections; ++i) {
      const double z = 1 - (2 * i + 1.0) / kCoreDirections, across = std::sqrt(1 - z * z),
                   angle = 2.399963229728653 * i;
      list[static_cast<std::size_t>(i)] = Vector(across * std::cos(angle), across * std::sin(angle), z);
    }
    return list;
  }();
  return directions;
}

// What a node answers for: medial vertices, or forming points where vertices are too few. Where many points lie on one
// sphere, as around the axis of a cylinder, they have coalesced into one vertex, which could not be split.
struct Members {
  std::vector<Index> items;  // vertices of the axis, or its points
  bool points = false;

  std::span<const Index> forming_points(const MedialAxis& axis, std::size_t i) const {
    return points ? std::span(&items[i], 1) : axis.forming_points[items[i]];
  }
};

// Members merged into one sphere.
struct Group {
  Sphere sphere;
  Members members;
};

constexpr std::size_t kNearPoints = 6;  // neighbours of a point that stand for adjacency where there is none
// Vertices fewer than the children, with this many forming points for each child, are worth taking apart.
constexpr std::size_t kPointsPerChild = 4;
// A sphere as tight as this, as a fraction of R, is left as it is.
constexpr double kTight = 1e-3;

// A pair of groups that some Voronoi edge joins, with the sphere that would replace them cached.
struct Candidate {
  double cost;
  Index a, b;  // a < b
  Sphere sphere;
};
// The queue's head is the cheapest; ties go to the lowest indices, so that the result is the same everywhere.
struct Dearer {
  bool operator()(const Candidate& x, const Candidate& y) const {
    if (x.cost != y.cost) return x.cost > y.cost;
    return x.a != y.a ? x.a > y.a : x.b > y.b;
  }
};

std::vector<Index> points_of(const MedialAxis& axis, const Members& members) {
  std::vector<Index> all;
  for (std::size_t i = 0; i < members.items.size(); ++i) {
    const auto points = members.forming_points(axis, i);
    all.insert(all.end(), points.begin(), points.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

// Merges the spheres of a set of members along the axis until few enough remain (dissertation 6.3.1).
//
// Two departures make it fast. A group's cost and sphere come from a core, the extreme points of its forming points;
// only the groups that remain in the end are fitted to all of them. And candidates are not re-keyed when a group grows:
// since a larger group costs more to join, an outdated cost is a lower bound, and bringing it up to date when it
// reaches the queue's head gives the same order.
class Merger {
 public:
  Merger(const MedialAxis& axis, const Members& members, std::vector<Index>& node_of) : axis_(axis), members_(members) {
    const auto count = static_cast<Index>(members.items.size());
    nodes_.reserve(2 * count);
    for (Index i = 0; i < count; ++i) {
      const auto points = members.forming_points(axis, i);
      const Index item = members.items[i];
      const Sphere sphere =
          members.points ? Sphere{axis.points[item], 0} : Sphere{axis.centers[item], axis.radii[item]};
      nodes_.push_back({sphere, {points.begin(), points.end()}, kNone});
    }
    if (members.points) {
      join_near_points();
    } else {
      join_adjacent_vertices(node_of);
    }
    alive_ = count;
  }

  std::vector<Group> run(std::size_t target) {
    if (alive_ > target)
      for (const auto& [a, b] : edges_) queue_.push(candidate(a, b));
    while (alive_ > target) {
      if (queue_.empty()) {
        merge(cheapest_join_of_components());
        continue;
      }
      const Candidate head = queue_.top();
      queue_.pop();
      const Index a = current(head.a), b = current(head.b);
      if (a == b) continue;
      if (a == head.a && b == head.b) {
        merge(head);
      } else if (keyed_.insert(key(a, b)).second) {
        queue_.push(candidate(a, b));
      }
    }
    return groups();
  }

 private:
  // A merged set; `into` is the set that swallowed it, so that indices form a forest.
  struct Node {
    Sphere sphere;
    std::vector<Index> core;  // some of its forming points
    Index into;
  };

  void join_adjacent_vertices(std::vector<Index>& node_of) {
    const auto count = static_cast<Index>(members_.items.size());
    for (Index i = 0; i < count; ++i) node_of[members_.items[i]] = i;
    for (Index i = 0; i < count; ++i)
      for (Index neighbor : axis_.neighbors[members_.items[i]])
        if (node_of[neighbor] != kNone && i < node_of[neighbor]) edges_.push_back({i, node_of[neighbor]});
    for (Index vertex : members_.items) node_of[vertex] = kNone;
  }

  // O(n^2), for the few points of fewer vertices than a node has children.
  void join_near_points() {
    const auto count = static_cast<Index>(members_.items.size());
    std::vector<std::pair<double, Index>> near;
    for (Index i = 0; i < count; ++i) {
      near.clear();
      for (Index k = 0; k < count; ++k)
        if (k != i)
          near.emplace_back((axis_.points[members_.items[k]] - axis_.points[members_.items[i]]).squaredNorm(), k);
      const auto some = static_cast<std::ptrdiff_t>(std::min(kNearPoints, near.size()));
      std::partial_sort(near.begin(), near.begin() + some, near.end());
      for (std::ptrdiff_t k = 0; k < some; ++k) {
        const Index other = near[static_cast<std::size_t>(k)].second;
        edges_.push_back({std::min(i, other), std::max(i, other)});
      }
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }

  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

  Index current(Index node) {
    Index root = node;
    while (nodes_[root].into != kNone) root = nodes_[root].into;
    while (nodes_[node].into != kNone) node = std::exchange(nodes_[node].into, root);
    return root;
  }

  // The looseness of the sphere around its forming points: how far it stands off the tangent plane at each of them,
  // where the line through the point along its normal leaves the sphere (Fig. 6.25). The last term is positive where
  // the centre lies in front of the surface.
  double cost_of(const Sphere& sphere, const std::vector<Index>& points) const {
    double worst = 0;
    for (Index point : points) {
      const Vector offset = sphere.center - axis_.points[point];
      const double height = offset.dot(axis_.normals[point]);
      const double across = std::max(0.0, offset.squaredNorm() - height * height);
      worst = std::max(worst, std::sqrt(std::max(0.0, sphere.radius * sphere.radius - across)) + height);
    }
    return worst;
  }

  Candidate candidate(Index a, Index b) {
    std::vector<Index>& points = scratch_;
    points = nodes_[a].core;
    points.insert(points.end(), nodes_[b].core.begin(), nodes_[b].core.end());
    const Sphere sphere = ritter_ball(positions_of(points));
    return {cost_of(sphere, points), std::min(a, b), std::max(a, b), sphere};
  }

  const std::vector<Point>& positions_of(const std::vector<Index>& points) {
    positions_.clear();
    for (Index point : points) positions_.push_back(axis_.points[point]);
    return positions_;
  }

  void merge(const Candidate& pair) {
    Node& a = nodes_[pair.a];
    Node& b = nodes_[pair.b];
    std::vector<Index> core;
    std::set_union(a.core.begin(), a.core.end(), b.core.begin(), b.core.end(), std::back_inserter(core));
    a.core = b.core = {};
    a.into = b.into = static_cast<Index>(nodes_.size());
    if (core.size() > kCoreDirections) core = extreme_points(core);
    nodes_.push_back({pair.sphere, std::move(core), kNone});
    --alive_;
  }

  std::vector<Index> extreme_points(const std::vector<Index>& points) {
    std::vector<Index> extreme;
    for (const Vector& direction : core_directions()) {
      Index best = points[0];
      for (Index point : points)
        if (direction.dot(axis_.points[point]) > direction.dot(axis_.points[best])) best = point;
      extreme.push_back(best);
    }
    std::sort(extreme.begin(), extreme.end());
    extreme.erase(std::unique(extreme.begin(), extreme.end()), extreme.end());
    return extreme;
  }

  // More components than children: the smallest sphere joins the group that it costs least to join.
  Candidate cheapest_join_of_components() {
    Index smallest = kNone;
    for (Index i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].into == kNone && (smallest == kNone || nodes_[i].sphere.radius < nodes_[smallest].sphere.radius))
        smallest = i;
    Candidate best{std::numeric_limits<double>::infinity(), kNone, kNone, {}};
    for (Index i = 0; i < nodes_.size(); ++i) {
      if (i == smallest || nodes_[i].into != kNone) continue;
      const Candidate pair = candidate(smallest, i);
      if (Dearer()(best, pair)) best = pair;
    }
    return best;
  }

  std::vector<Group> groups() {
    std::vector<Index> group_of(nodes_.size(), kNone);
    std::vector<Group> result;
    for (Index i = 0; i < members_.items.size(); ++i) {
      const Index root = current(i);
      if (group_of[root] == kNone) {
        group_of[root] = static_cast<Index>(result.size());
        result.push_back({nodes_[root].sphere, {{}, members_.points}});
      }
      result[group_of[root]].members.items.push_back(members_.items[i]);
    }
    for (Group& group : result) fit(group);
    return result;
  }

  // Makes the sphere hold all forming points, with the centre drawn towards the farthest one in shrinking steps (Badoiu
  // and Clarkson 2003), which takes most of the 5 % that Ritter's ball is too large.
  void fit(Group& group) {
    std::vector<Index>& all = scratch_;
    all = points_of(axis_, group.members);
    const std::vector<Point>& points = positions_of(all);
    Point center = group.sphere.center;
    group.sphere.radius = std::numeric_limits<double>::infinity();
    for (int pass = 1; pass <= 64; ++pass) {
      const auto nearer = [&](const Point& p, const Point& q) {
        return (p - center).squaredNorm() < (q - center).squaredNorm();
      };
      const Point& farthest = *std::max_element(points.begin(), points.end(), nearer);
      const double radius = (farthest - center).norm() * (1 + 0x1p-50);
      if (radius < group.sphere.radius) group.sphere = {center, radius};
      if (group.members.items.size() == 1) return;  // a medial sphere touches its points as it is
      center += (farthest - center) * (0.2 / pass);
    }
  }

  const MedialAxis& axis_;
  const Members& members_;
  std::vector<std::array<Index, 2>> edges_;
  std::vector<Node> nodes_;
  std::size_t alive_ = 0;
  std::priority_queue<Candidate, std::vector<Candidate>, Dearer> queue_;
  std::unordered_set<std::uint64_t> keyed_;  // pairs that were brought up to date; never iterated
  std::vector<Index> scratch_;
  std::vector<Point> positions_;
};

// The sphere of a group never has radius 0, not even around a single point.
Sphere padded(const Sphere& sphere, double margin) { return {sphere.center, sphere.radius + margin}; }

// Takes vertices apart into their points where they are too few for the children of a loose sphere.
void take_apart(const MedialAxis& axis, const Surface& surface, const Sphere& sphere, Index branching,
                Members& members) {
  if (members.points || members.items.size() >= branching) return;
  std::vector<Index> points = points_of(axis, members);
  if (points.size() < kPointsPerChild * branching) return;
  if (sphere.radius + surface.signed_distance(sphere.center) <= kTight * surface.bounding_radius()) return;
  members = {std::move(points), true};
}

}  // namespace

SphereTree merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options,
                      const Progress& progress) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (axis.size() == 0) throw InputError("the medial axis has no vertex: sample the surface more densely");
  const double margin = tolerance::kCoverMargin * surface.bounding_radius();
  SphereTree tree;
  tree.branching = options.branching;
  tree.nodes.push_back({.sphere = padded(surface.bounding_ball(), margin)});
  std::vector<Members> members(1);
  for (Index i = 0; i < axis.size(); ++i) members[0].items.push_back(i);
  std::vector<Index> node_of(axis.size(), kNone);  // scratch
  for (Index i = 0; i < tree.nodes.size(); ++i) {
    if (i % 16 == 0)
      report_progress(progress, "merging", static_cast<double>(i) / static_cast<double>(tree.nodes.size() + i));
    const SphereNode node = tree.nodes[i];
    if (node.level == options.depth || !wants_children(options.refinement, surface, node.sphere)) continue;
    take_apart(axis, surface, node.sphere, options.branching, members[i]);
    if (members[i].items.size() < 2) continue;  // a single medial sphere or point stays a leaf
    std::vector<Group> groups = Merger(axis, members[i], node_of).run(options.branching);
    tree.nodes[i].first_child = static_cast<Index>(tree.nodes.size());
    tree.nodes[i].child_count = static_cast<Index>(groups.size());
    for (Group& group : groups) {
      tree.nodes.push_back({.sphere = padded(group.sphere, margin), .parent = i, .level = node.level + 1});
      members.push_back(std::move(group.members));
    }
    members[i] = {};
  }
  return tree;
}

}  // namespace orchard
