#include "neck_test.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// A part of a border between two cells: where it runs through one triangle.
struct Stretch {
  Index other, triangle;
  std::uint8_t edges;
};

// Whether the stretches of one border hang together. Those on triangles that share an edge do if either ends on it; a
// border that runs through a vertex or along an edge is told by the positions of its ends.
class SingleArc {
 public:
  SingleArc(const Surface& surface, const RestrictedVoronoi& restricted, Index cell)
      : surface_(surface), restricted_(restricted), cell_(cell) {}

  bool operator()(std::span<const Stretch> stretches) {
    if (stretches.size() < 2) return true;
    stretches_ = stretches;
    if (connected([&](std::size_t i, std::size_t k) { return joined_across_edge(stretches_[i], stretches_[k]); })) {
      return true;
    }
    ends_.clear();
    for (const Stretch& stretch : stretches_) ends_.push_back(ends_of(stretch));
    return connected([&](std::size_t i, std::size_t k) { return ends_meet(ends_[i], ends_[k]); });
  }

 private:
  using Ends = std::vector<Point>;

  template <typename Joined>
  bool connected(const Joined& joined) {
    reached_.assign(stretches_.size(), 0);
    open_.assign(1, 0);
    reached_[0] = 1;
    std::size_t count = 1;
    while (!open_.empty()) {
      const std::size_t at = open_.back();
      open_.pop_back();
      for (std::size_t next = 0; next < stretches_.size(); ++next) {
        if (reached_[next] || !joined(at, next)) continue;
        reached_[next] = 1;
        open_.push_back(next);
        ++count;
      }
    }
    return count == stretches_.size();
  }

  bool joined_across_edge(const Stretch& a, const Stretch& b) const {
    for (unsigned edge = 0; edge < 3; ++edge) {
      if (surface_.neighbors(a.triangle)[edge] == b.triangle && (a.edges >> edge & 1u)) return true;
      if (surface_.neighbors(b.triangle)[edge] == a.triangle && (b.edges >> edge & 1u)) return true;
    }
    return false;
  }
  Ends ends_of(const Stretch& stretch) {
    Ends ends;
    restricted_.polygon(stretch.triangle, cell_, polygon_);
    const std::size_t size = polygon_.corners.size();
    for (std::size_t i = 0; i < size; ++i) {
      if (polygon_.labels[i] != stretch.other + 3) continue;
      ends.push_back(polygon_.corners[i]);
      ends.push_back(polygon_.corners[i + 1 == size ? 0 : i + 1]);
    }
    return ends;
  }
  bool ends_meet(const Ends& a, const Ends& b) const {
    const double near = 4 * tolerance::kTouch * surface_.bounding_radius();
    for (const Point& first : a) {
      for (const Point& second : b) {
        if ((first - second).squaredNorm() <= near * near) return true;
      }
    }
    return false;
  }

  const Surface& surface_;
  const RestrictedVoronoi& restricted_;
  Index cell_;
  std::span<const Stretch> stretches_;
  std::vector<std::uint8_t> reached_;
  std::vector<std::size_t> open_;
  std::vector<Ends> ends_;
  CellPolygon polygon_;
};

}  // namespace

NeckFault find_neck(const Surface& surface, const RestrictedVoronoi& restricted, const CellPatch& patch) {
  std::vector<Stretch> stretches;
  for (const Index triangle : patch.triangles) {
    for (const CellBorder& border : restricted.piece(triangle, patch.cell)->borders) {
      stretches.push_back({border.cell, triangle, border.edges});
    }
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.other < b.other; });
  NeckFault fault;
  SingleArc single_arc(surface, restricted, patch.cell);
  std::vector<Index> neighbors;
  for (std::size_t first = 0, end = 0; first < stretches.size(); first = end) {
    const Index other = stretches[first].other;
    while (end < stretches.size() && stretches[end].other == other) ++end;
    neighbors.push_back(other);
    if (other > patch.cell && !single_arc({&stretches[first], end - first})) fault.neighbors.push_back(other);
  }
  if (patch.euler_characteristic != 1 || neighbors.size() < 3) fault.neighbors = neighbors;
  fault.found = !fault.neighbors.empty() || neighbors.empty();
  return fault;
}

std::pair<Point, Index> farthest_corner(const RestrictedVoronoi& restricted, const CellPatch& patch, Index neighbor) {
  std::pair<Point, Index> farthest{Point::Zero(), kNone};
  double squared = -1;
  CellPolygon polygon;
  for (const Index triangle : patch.triangles) {
    restricted.polygon(triangle, patch.cell, polygon);
    const std::size_t size = polygon.corners.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Index before = polygon.labels[i == 0 ? size - 1 : i - 1], after = polygon.labels[i];
      if (neighbor != kNone && before != neighbor + 3 && after != neighbor + 3) continue;
      const double candidate = (polygon.corners[i] - restricted.points()[patch.cell]).squaredNorm();
      if (candidate <= squared) continue;
      squared = candidate;
      farthest = {polygon.corners[i], triangle};
    }
  }
  return farthest;
}

}  // namespace orchard::detail
