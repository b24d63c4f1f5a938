#include "moving_octree.h"

#include <algorithm>
#include <cmath>

namespace orchard::bench {
namespace {

constexpr std::size_t kFew = 8;         // bodies in a leaf that is not divided
constexpr std::uint32_t kDeepest = 10;  // levels
constexpr double kRoomToMove = 1.5;     // of the root's edge over what the bodies need, if they are moved

}  // namespace

MovingOctree::MovingOctree(const std::vector<Vec3>& positions, const std::vector<double>& radii, const Options& options)
    : positions_(positions), radii_(radii), options_(options) {}

std::size_t MovingOctree::memory_bytes() const {
  std::size_t bytes = nodes_.capacity() * sizeof(Node) + ranges_.capacity() * sizeof(Range);
  for (const Node& node : nodes_) bytes += node.bodies.capacity() * sizeof(BodyIndex);
  return bytes + free_.capacity() * sizeof(std::uint32_t);
}

bool MovingOctree::range_of(BodyIndex body, Range& range) const {
  const double edge = static_cast<double>(1u << levels_);
  for (std::size_t d = 0; d < 3; ++d) {
    const double x = (positions_[body][d] - origin_[d]) * per_length_, r = radii_[body] * per_length_;
    if (!(x - r >= 0) || !(x + r < edge)) return false;
    range.first[d] = static_cast<std::uint32_t>(x - r);
    range.last[d] = static_cast<std::uint32_t>(x + r);
  }
  return true;
}

bool MovingOctree::meets(const Cell& cell, const Range& range) {
  bool meet = true;
  for (std::size_t d = 0; d < 3; ++d)
    meet = meet && range.first[d] < cell.corner[d] + cell.edge && cell.corner[d] <= range.last[d];
  return meet;
}

MovingOctree::Cell MovingOctree::child(const Cell& cell, std::uint32_t part) const {
  const std::uint32_t edge = cell.edge / 2;
  Cell result{nodes_[cell.node].children + part, cell.corner, edge};
  for (std::uint32_t d = 0; d < 3; ++d) result.corner[d] += (part >> d & 1) * edge;
  return result;
}

std::uint32_t MovingOctree::eight_nodes() {
  if (!free_.empty()) {
    const std::uint32_t first = free_.back();
    free_.pop_back();
    return first;
  }
  const auto first = static_cast<std::uint32_t>(used_);
  used_ += 8;
  if (nodes_.size() < used_) nodes_.resize(used_);
  for (std::size_t i = first; i < used_; ++i) nodes_[i].children = 0, nodes_[i].bodies.clear();
  return first;
}

void MovingOctree::insert(const Cell& cell, BodyIndex body) {
  if (nodes_[cell.node].children == 0) {
    nodes_[cell.node].bodies.push_back(body);
    if (nodes_[cell.node].bodies.size() > kFew && cell.edge > 1) divide(cell);
    return;
  }
  for (std::uint32_t part = 0; part < 8; ++part) {
    const Cell inner = child(cell, part);
    if (meets(inner, ranges_[body])) insert(inner, body);
  }
}

void MovingOctree::divide(const Cell& cell) {
  const std::uint32_t children = eight_nodes();
  nodes_[cell.node].children = children;
  for (std::size_t i = 0; i < nodes_[cell.node].bodies.size(); ++i) {
    const BodyIndex body = nodes_[cell.node].bodies[i];
    for (std::uint32_t part = 0; part < 8; ++part) {
      const Cell inner = child(cell, part);
      if (meets(inner, ranges_[body])) insert(inner, body);
    }
  }
  nodes_[cell.node].bodies.clear();
}

void MovingOctree::remove(const Cell& cell, BodyIndex body, const Range& range) {
  if (nodes_[cell.node].children == 0) {
    std::vector<BodyIndex>& bodies = nodes_[cell.node].bodies;
    *std::find(bodies.begin(), bodies.end(), body) = bodies.back();
    bodies.pop_back();
    return;
  }
  for (std::uint32_t part = 0; part < 8; ++part) {
    const Cell inner = child(cell, part);
    if (meets(inner, range)) remove(inner, body, range);
  }
  join(cell.node);
}

// Eight leaves that have half of what a leaf may have, all together, become one.
void MovingOctree::join(std::uint32_t node) {
  const std::uint32_t children = nodes_[node].children;
  std::size_t count = 0;
  for (std::uint32_t part = 0; part < 8; ++part) {
    if (nodes_[children + part].children != 0) return;
    count += nodes_[children + part].bodies.size();
  }
  if (count > kFew / 2) return;
  std::vector<BodyIndex>& bodies = nodes_[node].bodies;
  for (std::uint32_t part = 0; part < 8; ++part) {
    std::vector<BodyIndex>& of_child = nodes_[children + part].bodies;
    bodies.insert(bodies.end(), of_child.begin(), of_child.end());
    of_child.clear();
  }
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  nodes_[node].children = 0;
  free_.push_back(children);
}

void MovingOctree::rebuild() {
  Vec3 low = positions_[0], high = positions_[0];
  double widest = 0, radius = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], positions_[i][d] - radii_[i]);
      high[d] = std::max(high[d], positions_[i][d] + radii_[i]);
    }
    radius += radii_[i] / static_cast<double>(positions_.size());
  }
  for (std::size_t d = 0; d < 3; ++d) widest = std::max(widest, high[d] - low[d]);
  const double edge = widest * (options_.upkeep == Upkeep::updated ? kRoomToMove : 1 + 1e-9);
  origin_ = 0.5 * (low + high) - Vec3{edge / 2, edge / 2, edge / 2};
  const double levels = std::floor(std::log2(std::max(1.0, edge / (2 * radius))));
  levels_ = std::min(kDeepest, static_cast<std::uint32_t>(levels));
  per_length_ = static_cast<double>(1u << levels_) / edge;
  used_ = 1;
  free_.clear();
  if (nodes_.empty()) nodes_.resize(1);
  nodes_[0].children = 0, nodes_[0].bodies.clear();
  ranges_.resize(positions_.size());
  for (BodyIndex i = 0; i < positions_.size(); ++i) {
    range_of(i, ranges_[i]);
    insert(root(), i);
  }
}

bool MovingOctree::meet(BodyIndex a, BodyIndex b) const {
  const Vec3 apart = positions_[a] - positions_[b];
  const double reach = radii_[a] + radii_[b];
  if (!options_.cubes) return dot(apart, apart) <= reach * reach;
  return std::fabs(apart[0]) <= reach && std::fabs(apart[1]) <= reach && std::fabs(apart[2]) <= reach;
}

// A pair counts in the leaf that has the lower corner of the cells that both are in.
void MovingOctree::compare(const Cell& cell, std::vector<BodyPair>& pairs) const {
  const Node& node = nodes_[cell.node];
  if (node.children != 0) {
    for (std::uint32_t part = 0; part < 8; ++part) compare(child(cell, part), pairs);
    return;
  }
  for (std::size_t i = 0; i < node.bodies.size(); ++i) {
    for (std::size_t k = i + 1; k < node.bodies.size(); ++k) {
      const BodyIndex a = node.bodies[i], b = node.bodies[k];
      if (!meet(a, b)) continue;
      bool here = true;
      for (std::size_t d = 0; d < 3; ++d) {
        const std::uint32_t corner = std::max(ranges_[a].first[d], ranges_[b].first[d]);
        here = here && cell.corner[d] <= corner && corner < cell.corner[d] + cell.edge;
      }
      if (here) pairs.push_back({std::min(a, b), std::max(a, b)});
    }
  }
}

void MovingOctree::find(std::vector<BodyPair>& pairs) {
  if (positions_.empty()) return;
  bool fits = options_.upkeep == Upkeep::updated && !ranges_.empty();
  for (BodyIndex i = 0; i < positions_.size() && fits; ++i) {
    Range now{};
    fits = range_of(i, now);
    if (!fits || now == ranges_[i]) continue;
    remove(root(), i, ranges_[i]);
    ranges_[i] = now;
    insert(root(), i);
  }
  if (!fits) rebuild();
  compare(root(), pairs);
}

}  // namespace orchard::bench
