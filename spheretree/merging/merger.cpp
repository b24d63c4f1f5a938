#include "merger.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <queue>
#include <unordered_set>
#include <utility>

#include "orchard/geometry/min_ball.h"

namespace orchard::detail {
namespace {

// The number of directions, spread over the sphere by the golden angle. The extreme points of a group along them
// represent all of its points.
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

// A pair of adjacent groups, with the sphere that would replace both.
struct Candidate {
  double cost;
  Index a, b;  // a < b
  Sphere sphere;
};
// The head of the queue is the cheapest pair, and of equal ones the one with the lowest indices, so that the result is
// the same on every machine.
struct HigherCost {
  bool operator()(const Candidate& x, const Candidate& y) const {
    if (x.cost != y.cost) return x.cost > y.cost;
    return x.a != y.a ? x.a > y.a : x.b > y.b;
  }
};

// Two departures from the dissertation make it fast. A group's cost and sphere come from a core, the extreme points of
// its forming points. And candidates are not re-keyed when a group grows: since a larger group costs more to join, an
// outdated cost is a lower bound, and bringing it up to date when it reaches the queue's head gives the same order.
class Merger {
 public:
  Merger(const MedialAxis& axis, const Parts& parts)
      : axis_(axis), edges_(parts.adjacent), count_(static_cast<Index>(parts.spheres.size())), alive_(count_) {
    nodes_.reserve(2 * std::size_t{count_});
    for (Index i = 0; i < count_; ++i) nodes_.push_back({parts.spheres[i], parts.points[i], kNone});
  }

  std::vector<MergedParts> run(std::size_t target) {
    if (alive_ > target && !keyed_all_) {
      keyed_all_ = true;
      std::vector<Candidate> first;
      first.reserve(edges_.size());
      for (const auto& [a, b] : edges_) first.push_back(candidate(a, b));
      queue_ = Queue(HigherCost(), std::move(first));
    }
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
  // A merged group. `into` is the group that it was merged into, so that the indices form a forest.
  struct Node {
    Sphere sphere;
    std::vector<Index> core;  // the extreme points of the group
    Index into;
  };
  using Queue = std::priority_queue<Candidate, std::vector<Candidate>, HigherCost>;

  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

  Index current(Index node) {
    Index root = node;
    while (nodes_[root].into != kNone) root = nodes_[root].into;
    while (nodes_[node].into != kNone) node = std::exchange(nodes_[node].into, root);
    return root;
  }

  // The looseness of the sphere around its points: how far it stands off the tangent plane at each of them, where the
  // line through the point along its normal leaves the sphere (Fig. 6.25). The last term is positive where the centre
  // lies in front of the surface.
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
    scratch_ = nodes_[a].core;
    scratch_.insert(scratch_.end(), nodes_[b].core.begin(), nodes_[b].core.end());
    positions_.clear();
    for (Index point : scratch_) positions_.push_back(axis_.points[point]);
    const Sphere sphere = ritter_ball(positions_);
    return {cost_of(sphere, scratch_), std::min(a, b), std::max(a, b), sphere};
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

  std::vector<Index> extreme_points(const std::vector<Index>& points) const {
    std::vector<Index> extreme;
    for (const Vector& direction : core_directions()) {
      Index best = points[0];
      double max = direction.dot(axis_.points[best]);
      for (Index point : points) {
        const double along = direction.dot(axis_.points[point]);
        if (along > max) max = along, best = point;
      }
      extreme.push_back(best);
    }
    std::sort(extreme.begin(), extreme.end());
    extreme.erase(std::unique(extreme.begin(), extreme.end()), extreme.end());
    return extreme;
  }

  // If more components remain than groups are wanted, the smallest sphere is merged with the group for which this costs
  // least.
  Candidate cheapest_join_of_components() {
    Index min = kNone;
    for (Index i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].into == kNone && (min == kNone || nodes_[i].sphere.radius < nodes_[min].sphere.radius)) min = i;
    Candidate best{std::numeric_limits<double>::infinity(), kNone, kNone, {}};
    for (Index i = 0; i < nodes_.size(); ++i) {
      if (i == min || nodes_[i].into != kNone) continue;
      const Candidate pair = candidate(min, i);
      if (HigherCost()(best, pair)) best = pair;
    }
    return best;
  }

  std::vector<MergedParts> groups() {
    std::vector<Index> group_of(nodes_.size(), kNone);
    std::vector<MergedParts> result;
    for (Index i = 0; i < count_; ++i) {
      const Index root = current(i);
      if (group_of[root] == kNone) {
        group_of[root] = static_cast<Index>(result.size());
        result.push_back({nodes_[root].sphere, {}});
      }
      result[group_of[root]].parts.push_back(i);
    }
    return result;
  }

  const MedialAxis& axis_;
  const std::vector<std::array<Index, 2>>& edges_;
  const Index count_;
  std::vector<Node> nodes_;
  std::size_t alive_;
  Queue queue_;
  std::unordered_set<std::uint64_t> keyed_;  // pairs whose cost was updated; never iterated
  bool keyed_all_ = false;                   // whether the pairs that were adjacent at first have been updated
  std::vector<Index> scratch_;
  std::vector<Point> positions_;
};

}  // namespace

std::vector<std::vector<MergedParts>> merge_parts(const MedialAxis& axis, const Parts& parts,
                                                  std::span<const std::size_t> targets) {
  Merger merger(axis, parts);
  std::vector<std::vector<MergedParts>> groupings;
  for (const std::size_t target : targets) groupings.push_back(merger.run(target));
  return groupings;
}

void shrink_around(const std::vector<Point>& points, Sphere& sphere) {
  Point center = sphere.center;
  sphere.radius = std::numeric_limits<double>::infinity();
  for (int pass = 1; pass <= 64; ++pass) {
    const auto nearer = [&](const Point& p, const Point& q) {
      return (p - center).squaredNorm() < (q - center).squaredNorm();
    };
    const Point& farthest = *std::max_element(points.begin(), points.end(), nearer);
    const double radius = (farthest - center).norm() * (1 + 0x1p-50);
    if (radius < sphere.radius) sphere = {center, radius};
    center += (farthest - center) * (0.2 / pass);
  }
}

}  // namespace orchard::detail
