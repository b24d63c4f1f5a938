#include "orchard/spheretree/merging.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "orchard/geometry/error.h"
#include "orchard/geometry/min_ball.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

// A set of medial vertices merged into one sphere.
struct Group {
  Sphere sphere;
  std::vector<Index> vertices;   // of the medial axis, ascending
  std::vector<Index> points;     // forming points, ascending: what the sphere holds
  std::vector<Index> neighbors;  // groups, ascending
  bool alive = true;
};

// A pair of neighbouring groups, with the sphere that would replace them cached.
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

std::vector<Index> set_union_of(const std::vector<Index>& a, const std::vector<Index>& b) {
  std::vector<Index> both;
  both.reserve(a.size() + b.size());
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// Merges the spheres of a set of medial vertices along the axis until few enough remain (dissertation 6.3.1).
class Merger {
 public:
  Merger(const MedialAxis& axis, const std::vector<Index>& vertices, std::vector<Index>& group_of)
      : axis_(axis), group_of_(group_of) {
    groups_.reserve(2 * vertices.size());
    for (Index i = 0; i < vertices.size(); ++i) group_of_[vertices[i]] = i;
    for (Index vertex : vertices) add_vertex(vertex);
    for (Index vertex : vertices) group_of_[vertex] = kNone;
    alive_ = groups_.size();
  }

  std::vector<Group> run(std::size_t target) {
    for (Index a = 0; a < groups_.size() && alive_ > target; ++a)
      for (Index b : groups_[a].neighbors)
        if (a < b) consider(a, b);
    while (alive_ > target) {
      if (queue_.empty()) {
        join_components();
        continue;
      }
      const Candidate best = queue_.top();
      queue_.pop();
      if (groups_[best.a].alive && groups_[best.b].alive) merge(best);
    }
    std::erase_if(groups_, [](const Group& group) { return !group.alive; });
    for (Group& group : groups_) tighten(group);
    return std::move(groups_);
  }

 private:
  void add_vertex(Index vertex) {
    Group group;
    const auto points = axis_.forming_points[vertex];
    group.points.assign(points.begin(), points.end());
    group.sphere = {axis_.centers[vertex], 0};
    for (Index point : points)
      group.sphere.radius = std::max(group.sphere.radius, (axis_.points[point] - group.sphere.center).norm());
    group.vertices = {vertex};
    for (Index neighbor : axis_.neighbors[vertex])
      if (group_of_[neighbor] != kNone) group.neighbors.push_back(group_of_[neighbor]);
    std::sort(group.neighbors.begin(), group.neighbors.end());
    groups_.push_back(std::move(group));
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
    const std::vector<Index> points = set_union_of(groups_[a].points, groups_[b].points);
    const Sphere sphere = ritter_ball(positions_of(points));
    return {cost_of(sphere, points), std::min(a, b), std::max(a, b), sphere};
  }

  const std::vector<Point>& positions_of(const std::vector<Index>& points) {
    positions_.clear();
    for (Index point : points) positions_.push_back(axis_.points[point]);
    return positions_;
  }

  // Draws the centre towards the farthest point in shrinking steps (Badoiu and Clarkson 2003), which takes most of the
  // 5 % that Ritter's ball is too large. Too slow for every candidate, and worth it for those that stay.
  void tighten(Group& group) {
    const std::vector<Point>& points = positions_of(group.points);
    Point center = group.sphere.center;
    for (int pass = 1; pass <= 64; ++pass) {
      const auto farther = [&](const Point& p, const Point& q) {
        return (p - center).squaredNorm() < (q - center).squaredNorm();
      };
      const Point& farthest = *std::max_element(points.begin(), points.end(), farther);
      const double radius = (farthest - center).norm() * (1 + 0x1p-50);
      if (radius < group.sphere.radius) group.sphere = {center, radius};
      center += (farthest - center) * (0.2 / pass);
    }
  }

  void consider(Index a, Index b) { queue_.push(candidate(a, b)); }

  void merge(const Candidate& pair) {
    const auto merged = static_cast<Index>(groups_.size());
    Group group;
    group.sphere = pair.sphere;
    Group& a = groups_[pair.a];
    Group& b = groups_[pair.b];
    group.points = set_union_of(a.points, b.points);
    group.vertices = set_union_of(a.vertices, b.vertices);
    group.neighbors = set_union_of(a.neighbors, b.neighbors);
    std::erase_if(group.neighbors, [&](Index other) { return other == pair.a || other == pair.b; });
    for (Group* old : {&a, &b})
      *old = Group{.sphere = {}, .vertices = {}, .points = {}, .neighbors = {}, .alive = false};
    for (Index other : group.neighbors) {
      auto& row = groups_[other].neighbors;
      std::erase_if(row, [&](Index x) { return x == pair.a || x == pair.b; });
      row.push_back(merged);  // the largest index, so the row stays sorted
    }
    groups_.push_back(std::move(group));
    --alive_;
    for (Index other : groups_[merged].neighbors) consider(other, merged);
  }

  // More components than children: the group with the fewest points joins the one that it costs least to join.
  void join_components() {
    Index smallest = kNone;
    for (Index i = 0; i < groups_.size(); ++i)
      if (groups_[i].alive && (smallest == kNone || groups_[i].points.size() < groups_[smallest].points.size()))
        smallest = i;
    Candidate best{std::numeric_limits<double>::infinity(), kNone, kNone, {}};
    for (Index i = 0; i < groups_.size(); ++i) {
      if (i == smallest || !groups_[i].alive) continue;
      const Candidate pair = candidate(smallest, i);
      if (Dearer()(best, pair)) best = pair;
    }
    merge(best);
  }

  const MedialAxis& axis_;
  std::vector<Index>& group_of_;  // scratch over all medial vertices, kNone outside the constructor
  std::vector<Group> groups_;
  std::size_t alive_ = 0;
  std::priority_queue<Candidate, std::vector<Candidate>, Dearer> queue_;
  std::vector<Point> positions_;
};

// The sphere of a group never has radius 0, not even around a single point.
Sphere padded(const Sphere& sphere, double margin) { return {sphere.center, sphere.radius + margin}; }

}  // namespace

SphereTree merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options,
                      const Progress& progress) {
  if (options.branching < 2 || options.branching > 64) throw InputError("branching must lie between 2 and 64");
  if (axis.size() == 0) throw InputError("the medial axis has no vertex: sample the surface more densely");
  const double margin = tolerance::kCoverMargin * surface.bounding_radius();
  SphereTree tree;
  tree.branching = options.branching;
  tree.nodes.push_back({.sphere = padded(surface.bounding_ball(), margin)});
  std::vector<std::vector<Index>> members(1);
  for (Index i = 0; i < axis.size(); ++i) members[0].push_back(i);
  std::vector<Index> group_of(axis.size(), kNone);
  for (Index i = 0; i < tree.nodes.size(); ++i) {
    if (i % 16 == 0)
      report_progress(progress, "merging", static_cast<double>(i) / static_cast<double>(tree.nodes.size() + i));
    // A single medial sphere cannot be split: it stays a leaf.
    if (tree.nodes[i].level == options.depth || members[i].size() < 2) continue;
    std::vector<Group> groups = Merger(axis, members[i], group_of).run(options.branching);
    members[i] = {};
    tree.nodes[i].first_child = static_cast<Index>(tree.nodes.size());
    tree.nodes[i].child_count = static_cast<Index>(groups.size());
    for (Group& group : groups) {
      tree.nodes.push_back({.sphere = padded(group.sphere, margin), .parent = i, .level = tree.nodes[i].level + 1});
      members.push_back(std::move(group.vertices));
    }
  }
  return tree;
}

}  // namespace orchard
