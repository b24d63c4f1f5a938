#include "neck_test.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// The part of the border between two cells in one triangle.
struct Stretch {
  Index other, triangle;
  std::uint8_t edges;
};

// Whether the stretches of one border form a single arc. Stretches in triangles that share an edge are joined if one of
// them ends on this edge. Where a border runs through a vertex or along an edge, the positions of its ends decide. A
// border can have very many stretches (around the middle of a fan it crosses every triangle), so stretches are never
// all compared with all.
class SingleArc {
 public:
  SingleArc(const Surface& surface, const RestrictedVoronoi& restricted, Index cell)
      : surface_(surface), restricted_(restricted), cell_(cell) {}

  // The stretches ascend by triangle.
  bool operator()(std::span<const Stretch> stretches) {
    if (stretches.size() < 2) return true;
    return joined_across_edges(stretches) || joined_at_ends(stretches);
  }

 private:
  // Sets of stretches, and how many there are.
  struct Arcs {
    explicit Arcs(std::size_t size) : sets(size), count(size) {}
    void join(std::size_t a, std::size_t b) {
      const Index first = sets.root(static_cast<Index>(a)), second = sets.root(static_cast<Index>(b));
      if (first == second) return;
      sets.unite(first, second);
      --count;
    }
    DisjointSets sets;
    std::size_t count;
  };
  struct End {
    Point position;
    std::size_t stretch;
  };

  bool joined_across_edges(std::span<const Stretch> stretches) const {
    Arcs arcs(stretches.size());
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      for (unsigned edge = 0; edge < 3; ++edge) {
        if (!(stretches[i].edges >> edge & 1u)) continue;
        const Index across = surface_.neighbors(stretches[i].triangle)[edge];
        auto next =
            std::lower_bound(stretches.begin(), stretches.end(), across,
                             [](const Stretch& stretch, Index triangle) { return stretch.triangle < triangle; });
        for (; next != stretches.end() && next->triangle == across; ++next) {
          arcs.join(i, static_cast<std::size_t>(next - stretches.begin()));
        }
      }
    }
    return arcs.count == 1;
  }

  // Ends are sorted along the axis on which they spread most, and only those near each other along it are compared.
  bool joined_at_ends(std::span<const Stretch> stretches) {
    ends_.clear();
    Box box;
    for (std::size_t i = 0; i < stretches.size(); ++i) add_ends(stretches[i], i, box);
    if (ends_.empty()) return false;
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    std::sort(ends_.begin(), ends_.end(),
              [&](const End& a, const End& b) { return a.position[axis] < b.position[axis]; });
    const double near = 4 * tolerance::kTouch * surface_.bounding_radius();
    const double window =
        near * (1 + 0x1p-20);  // ends farther apart along the axis are not near, whatever the rounding
    Arcs arcs(stretches.size());
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      for (std::size_t k = i + 1; k < ends_.size(); ++k) {
        if (ends_[k].position[axis] - ends_[i].position[axis] > window) break;
        if ((ends_[i].position - ends_[k].position).squaredNorm() > near * near) continue;
        arcs.join(ends_[i].stretch, ends_[k].stretch);
      }
    }
    return arcs.count == 1;
  }
  void add_ends(const Stretch& stretch, std::size_t index, Box& box) {
    restricted_.polygon(stretch.triangle, cell_, polygon_);
    const std::size_t size = polygon_.corners.size();
    for (std::size_t i = 0; i < size; ++i) {
      if (polygon_.labels[i] != stretch.other + 3) continue;
      for (const std::size_t corner : {i, i + 1 == size ? 0 : i + 1}) {
        ends_.push_back({polygon_.corners[corner], index});
        box.extend(polygon_.corners[corner]);
      }
    }
  }

  const Surface& surface_;
  const RestrictedVoronoi& restricted_;
  Index cell_;
  std::vector<End> ends_;
  CellPolygon polygon_;
};

}  // namespace

NeckFault find_neck(const Surface& surface, const RestrictedVoronoi& restricted, const CellComponent& component) {
  std::vector<Stretch> stretches;
  for (const Index triangle : component.triangles) {
    for (const CellBorder& border : restricted.piece(triangle, component.cell)->borders) {
      stretches.push_back({border.cell, triangle, border.edges});
    }
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.other < b.other; });
  NeckFault fault;
  SingleArc single_arc(surface, restricted, component.cell);
  std::vector<Index> neighbors;
  for (std::size_t first = 0, end = 0; first < stretches.size(); first = end) {
    const Index other = stretches[first].other;
    while (end < stretches.size() && stretches[end].other == other) ++end;
    neighbors.push_back(other);
    if (other > component.cell && !single_arc({&stretches[first], end - first})) fault.neighbors.push_back(other);
  }
  if (component.euler_characteristic != 1 || neighbors.size() < 3) fault.neighbors = neighbors;
  fault.found = !fault.neighbors.empty() || neighbors.empty();
  return fault;
}

std::pair<Point, Index> farthest_corner(const RestrictedVoronoi& restricted, const CellComponent& component,
                                        Index neighbor) {
  std::pair<Point, Index> farthest{Point::Zero(), kNone};
  double squared = -1;
  CellPolygon polygon;
  for (const Index triangle : component.triangles) {
    restricted.polygon(triangle, component.cell, polygon);
    const std::size_t size = polygon.corners.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Index before = polygon.labels[i == 0 ? size - 1 : i - 1], after = polygon.labels[i];
      if (neighbor != kNone && before != neighbor + 3 && after != neighbor + 3) continue;
      const double candidate = (polygon.corners[i] - restricted.points()[component.cell]).squaredNorm();
      if (candidate <= squared) continue;
      squared = candidate;
      farthest = {polygon.corners[i], triangle};
    }
  }
  return farthest;
}

}  // namespace orchard::detail
