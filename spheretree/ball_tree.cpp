#include "orchard/spheretree/ball_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "orchard/spheretree/certify.h"
#include "orchard/spheretree/pack.h"
#include "packed_nodes.h"

namespace orchard {
namespace {

constexpr int kSteps = 200;         // towards the ball that reaches farthest
constexpr double kRounded = 1e-12;  // of a radius: more than what is rounded on the way to it

// A ball that holds all of these balls. It is a few percent larger than the smallest (Badoiu and Clarkson 2003).
Sphere ball_around(std::span<const Sphere> balls, std::span<const Index> which) {
  Sphere around = balls[which.front()];
  for (const Index b : which)
    around.center += (balls[b].center - balls[which.front()].center) / static_cast<double>(which.size());
  const auto farthest = [&] {
    double most = 0;
    Index best = which.front();
    for (const Index b : which) {
      const double reach = (balls[b].center - around.center).norm() + balls[b].radius;
      if (reach > most) most = reach, best = b;
    }
    return std::pair(most, best);
  };
  Sphere least{around.center, std::numeric_limits<double>::infinity()};
  for (int step = 1; step <= kSteps; ++step) {
    const auto [reach, ball] = farthest();
    if (reach < least.radius) least = {around.center, reach};
    const Vector away = balls[ball].center - around.center;
    const double distance = away.norm();
    if (!(distance > 0)) break;
    // Moves the centre towards the farthest point of that ball.
    around.center += reach / distance / (step + 1) * away;
  }
  least.radius *= 1 + kRounded;
  return least;
}

class TreeOverBalls {
 public:
  TreeOverBalls(std::span<const Sphere> balls, Index branching) : balls_(balls) { tree_.branching = branching; }

  SphereTree run() {
    std::vector<Index> all(balls_.size());
    std::iota(all.begin(), all.end(), Index{0});
    tree_.nodes.push_back({.sphere = ball_around(balls_, all)});
    std::vector<std::vector<Index>> groups{std::move(all)};
    for (std::size_t node = 0; node < groups.size(); ++node) {
      if (groups[node].size() <= 1 && node > 0) continue;
      std::vector<std::vector<Index>> parts = divided(std::move(groups[node]), tree_.branching);
      tree_.nodes[node].first_child = static_cast<Index>(tree_.nodes.size());
      tree_.nodes[node].child_count = static_cast<Index>(parts.size());
      for (std::vector<Index>& part : parts) {
        tree_.nodes.push_back({.sphere = part.size() == 1 ? balls_[part.front()] : ball_around(balls_, part),
                               .parent = static_cast<Index>(node),
                               .level = tree_.nodes[node].level + 1});
        groups.push_back(std::move(part));
      }
    }
    return std::move(tree_);
  }

 private:
  // Divides a group into `parts` parts: again and again the largest part is halved, across the longest side of its
  // centres' box.
  std::vector<std::vector<Index>> divided(std::vector<Index> group, Index parts) const {
    std::vector<std::vector<Index>> result{std::move(group)};
    while (result.size() < parts) {
      const auto largest = std::max_element(result.begin(), result.end(),
                                            [](const auto& a, const auto& b) { return a.size() < b.size(); });
      if (largest->size() <= 1) break;
      std::vector<Index> upper = split(*largest);
      result.insert(largest + 1, std::move(upper));
    }
    return result;
  }

  std::vector<Index> split(std::vector<Index>& group) const {
    Box box;
    for (const Index b : group) box.extend(balls_[b].center);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    std::sort(group.begin(), group.end(), [&](Index a, Index b) {
      const double at_a = balls_[a].center[axis], at_b = balls_[b].center[axis];
      return at_a < at_b || (at_a == at_b && a < b);
    });
    const auto middle = group.begin() + static_cast<std::ptrdiff_t>(group.size() / 2);
    std::vector<Index> upper(middle, group.end());
    group.erase(middle, group.end());
    return upper;
  }

  std::span<const Sphere> balls_;
  SphereTree tree_;
};

// Stores for each node an upper bound on the signed distance of its centre from the union of the balls (negative
// inside), and one on the distance of any of its points.
void measure_union(std::span<const Sphere> balls, SphereTree& tree) {
  tbb::parallel_for(std::size_t{0}, tree.nodes.size(), [&](std::size_t i) {
    SphereNode& node = tree.nodes[i];
    node.center_distance = node.distance_bound = std::numeric_limits<double>::infinity();
    for (const Sphere& ball : balls) {
      const double distance = (node.sphere.center - ball.center).norm() * (1 + kRounded);
      node.center_distance = std::min(node.center_distance, distance - ball.radius);
      node.distance_bound = std::min(node.distance_bound, distance + node.sphere.radius - ball.radius);
    }
    node.distance_bound = std::max(0.0, node.distance_bound);
  });
}

// Proves that the packed tree, with its floats as they are, covers the balls. Every rounding is taken in the direction
// that makes the proof harder.
class BallTreeProof {
 public:
  BallTreeProof(std::span<const Sphere> balls, const runtime::PackedSphereTree& packed)
      : packed_(packed), paths_(path_balls(packed)), nodes_(packed_nodes(packed)) {
    const Point origin(packed.origin[0], packed.origin[1], packed.origin[2]);
    for (const Sphere& ball : balls) {
      const Vector at = ball.center - origin;
      // The last number bounds the rounding of the difference, and of the sum of a length and a radius.
      balls_.push_back({at, ball.radius, 0x1p-50 * (at.norm() + ball.radius + origin.norm())});
    }
  }

  Index balls_unproven() const {
    return count(balls_.size(), [&](std::size_t b) {
      for (Index node = 0; node < paths_.size(); ++node)
        if (paths_[node].leaf && lies_on_path(balls_[b], node)) return true;
      return false;
    });
  }

  Index bounds_unproven() const {
    return count(paths_.size(), [&](std::size_t i) {
      const runtime::SiblingBlock& block = packed_.blocks[nodes_[i].block];
      const double depth = block.depth[nodes_[i].lane], error = block.error[nodes_[i].lane];
      bool has_depth = false, has_error = false;
      for (const Ball& ball : balls_) {
        const double distance = distance_bound(ball, paths_[i]);
        has_depth = has_depth || distance - ball.radius <= depth;
        has_error = has_error || distance + paths_[i].radius - ball.radius <= error;
      }
      return has_depth && has_error;
    });
  }

 private:
  struct Ball {
    Vector center;  // relative to the tree's origin
    double radius, rounding;
  };

  template <class IsProven>
  static Index count(std::size_t items, const IsProven& is_proven) {
    std::vector<char> unproven(items, 0);
    tbb::parallel_for(std::size_t{0}, items, [&](std::size_t i) { unproven[i] = is_proven(i) ? 0 : 1; });
    return static_cast<Index>(std::count(unproven.begin(), unproven.end(), 1));
  }

  static double distance_bound(const Ball& ball, const PathBall& node) {
    return (node.center - ball.center).norm() * (1 + 0x1p-50) + ball.rounding;
  }

  bool lies_on_path(const Ball& ball, Index leaf) const {
    for (Index node = leaf; node != kNone; node = paths_[node].parent)
      if (!(distance_bound(ball, paths_[node]) + ball.radius <= paths_[node].radius)) return false;
    return true;
  }

  const runtime::PackedSphereTree& packed_;
  std::vector<PathBall> paths_;
  std::vector<PackedNode> nodes_;
  std::vector<Ball> balls_;
};

}  // namespace

SphereTree ball_tree(std::span<const Sphere> balls, Index branching) { return TreeOverBalls(balls, branching).run(); }

BallTree pack_balls(std::span<const Sphere> balls) {
  SphereTree tree = ball_tree(balls);
  measure_union(balls, tree);
  BallTree result{.packed = pack(tree)};
  const BallTreeProof proof(balls, result.packed);
  result.balls_unproven = proof.balls_unproven();
  result.bounds_unproven = proof.bounds_unproven();
  return result;
}

}  // namespace orchard
