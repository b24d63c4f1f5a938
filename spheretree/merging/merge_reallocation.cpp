#include "merge_reallocation.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "orchard/spheretree/redundancy.h"
#include "sibling_balance.h"

namespace orchard::detail {
namespace {

constexpr double kSplitGain = 0.97;  // a split that leaves a larger share of the looseness is not worth another sphere

struct Holder {
  Index node = kNone;
  double radius = std::numeric_limits<double>::infinity();
};
// Finds the tightest leaf whose path contains the point.
void find_holder(const SphereTree& tree, Index index, const Point& point, Holder& best) {
  const SphereNode& node = tree.nodes[index];
  if ((point - node.sphere.center).squaredNorm() > node.sphere.radius * node.sphere.radius) return;
  if (node.child_count == 0 && node.sphere.radius < best.radius) best = {index, node.sphere.radius};
  for (Index k = 0; k < node.child_count; ++k) find_holder(tree, node.first_child + k, point, best);
}

struct Place {
  double loose;
  std::size_t family, child;
  bool operator<(const Place& other) const {
    if (loose != other.loose) return loose < other.loose;
    return family != other.family ? family > other.family : child > other.child;
  }
};

}  // namespace

Index remove_redundant_nodes(SphereTree& tree, const Surface& surface, std::vector<Portion>& portions) {
  const std::vector<SphereNode> before = tree.nodes;
  const Index level = tree.depth();
  const Index removed = remove_redundant(tree, surface).removed;
  if (removed == 0) return 0;
  std::vector<Portion> kept_portions(tree.nodes.size()), homeless;
  for (Index i = 0, k = 0; i < before.size(); ++i) {
    const bool kept = k < tree.nodes.size() && before[i].level == tree.nodes[k].level &&
                      before[i].sphere.center == tree.nodes[k].sphere.center &&
                      before[i].sphere.radius == tree.nodes[k].sphere.radius;
    if (kept) {
      kept_portions[k++] = std::move(portions[i]);
    } else if (before[i].level == level) {
      homeless.push_back(std::move(portions[i]));
    }
  }
  portions = std::move(kept_portions);
  for (const Portion& portion : homeless)
    for (std::size_t i = 0; i < portion.held.size(); ++i) {
      Holder best;
      find_holder(tree, 0, portion.held[i], best);
      if (best.node == kNone) continue;
      portions[best.node].held.push_back(portion.held[i]);
      portions[best.node].points.push_back(portion.points[i]);
    }
  return removed;
}

void split_loosest(const ChildBuilder& maker, Index branching, std::vector<std::vector<Child>>& families) {
  std::priority_queue<Place> loosest;
  Index room = 0;
  for (std::size_t i = 0; i < families.size(); ++i) {
    if (!families[i].empty()) room += branching;
    for (std::size_t k = 0; k < families[i].size(); ++k) {
      loosest.push({maker.looseness(families[i][k].sphere), i, k});
      --room;
    }
  }
  const std::size_t max = max_children(branching);
  for (; room > 0 && !loosest.empty();) {
    const Place at = loosest.top();
    loosest.pop();
    if (maker.tight(families[at.family][at.child].sphere)) return;
    std::vector<Child>& family = families[at.family];
    if (family.size() >= max) continue;
    std::vector<Child> two = maker.halves(family[at.child]);
    if (two.size() < 2) continue;
    const double first = maker.looseness(two[0].sphere), second = maker.looseness(two[1].sphere);
    if (std::max(first, second) > kSplitGain * at.loose) continue;
    family[at.child] = std::move(two[0]);
    family.push_back(std::move(two[1]));
    loosest.push({first, at.family, at.child});
    loosest.push({second, at.family, family.size() - 1});
    --room;
  }
}

}  // namespace orchard::detail
