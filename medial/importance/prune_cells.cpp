#include "prune_cells.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <queue>
#include <utility>

#include "../axis/axis_complex.h"
#include "../axis/contact_angles.h"
#include "../axis/incidence.h"

namespace orchard::detail {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

class Pruner {
 public:
  Pruner(const MedialAxis& axis, const CellLimits& limits, const std::vector<double>& over_limit)
      : axis_(axis),
        limits_(limits),
        complex_(axis),
        over_limit_(over_limit),
        vertex_alive_(axis.size(), 1),
        edge_alive_(complex_.edges().size(), 1),
        face_alive_(complex_.face_count(), 1) {}

  MedialAxis run() {
    for (Index face = 0; face < complex_.face_count(); ++face) offer_face(face);
    for (Index edge = 0; edge < edge_alive_.size(); ++edge) offer_edge(edge);
    while (!queue_.empty()) {
      const Cell cell = queue_.top().second;
      queue_.pop();
      if (cell.is_face) {
        collapse_face(cell.index);
      } else {
        collapse_edge(cell.index);
      }
    }
    return what_is_left();
  }

 private:
  struct Cell {
    bool is_face;
    Index index;
    bool operator<(const Cell& other) const {
      return is_face != other.is_face ? is_face < other.is_face : index > other.index;
    }
  };

  Index free_side(Index face) const {
    for (const Index edge : complex_.sides(face)) {
      if (edge_alive_[edge] && only(complex_.faces_at(edge), face_alive_) == face) return edge;
    }
    return kNone;
  }
  Index free_end(Index edge) const {
    for (const Index face : complex_.faces_at(edge)) {
      if (face_alive_[face]) return kNone;
    }
    for (const Index vertex : complex_.edges()[edge]) {
      if (only(complex_.edges_at(vertex), edge_alive_) == edge) return vertex;
    }
    return kNone;
  }

  // What an angle or half a distance of two points is beside its limit.
  double angle_over(double angle) const { return limits_.angle > 0 ? angle / limits_.angle : kNoLimit; }
  double lambda_over(double half) const { return limits_.lambda > 0 ? half / limits_.lambda : kNoLimit; }

  void offer_face(Index face) {
    if (!face_alive_[face] || free_side(face) == kNone) return;
    const auto corners = complex_.corners(face);
    const auto& [p, q] = complex_.points(face);
    double value = lambda_over(0.5 * (axis_.points[p] - axis_.points[q]).norm());
    if (limits_.angle > 0) value = std::min(value, angle_over(separation_angle(axis_, corners, {p, q})));
    for (const Index corner : corners) value = std::min(value, over_limit_[corner]);
    if (value < 1) queue_.emplace(-value, Cell{true, face});
  }
  void offer_edge(Index edge) {
    if (!edge_alive_[edge]) return;
    const Index end = free_end(edge);
    if (end == kNone) return;
    const double value = std::min(over_limit_[end], edge_over(edge));
    if (value < 1) queue_.emplace(-value, Cell{false, edge});
  }
  // By the two points that form the edge and are seen farthest apart from its middle.
  double edge_over(Index edge) const {
    const auto [a, b] = complex_.edges()[edge];
    std::vector<Index> common;
    const auto at_a = axis_.forming_points[a], at_b = axis_.forming_points[b];
    std::set_intersection(at_a.begin(), at_a.end(), at_b.begin(), at_b.end(), std::back_inserter(common));
    const Point middle = 0.5 * (axis_.centers[a] + axis_.centers[b]);
    double angle = 0, half = 0;
    for (std::size_t i = 0; i < common.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        angle = std::max(angle, seen_angle(axis_, middle, common[i], common[k]));
        half = std::max(half, 0.5 * (axis_.points[common[i]] - axis_.points[common[k]]).norm());
      }
    }
    if (!axis_.angles.empty()) angle = std::min(angle, std::max(axis_.angles[a], axis_.angles[b]));
    return std::min(angle_over(angle), lambda_over(half));
  }

  void collapse_face(Index face) {
    const Index side = face_alive_[face] ? free_side(face) : kNone;
    if (side == kNone) return;
    face_alive_[face] = edge_alive_[side] = 0;
    for (const Index edge : complex_.sides(face)) {
      for (const Index other : complex_.faces_at(edge)) offer_face(other);
    }
    for (const Index corner : complex_.corners(face)) offer_edges_at(corner);
  }
  void collapse_edge(Index edge) {
    const Index end = edge_alive_[edge] ? free_end(edge) : kNone;
    if (end == kNone) return;
    edge_alive_[edge] = vertex_alive_[end] = 0;
    for (const Index vertex : complex_.edges()[edge]) offer_edges_at(vertex);
  }
  void offer_edges_at(Index vertex) {
    for (const Index edge : complex_.edges_at(vertex)) offer_edge(edge);
  }

  MedialAxis what_is_left() const {
    MedialAxis result;
    result.points = axis_.points;
    result.normals = axis_.normals;
    result.turns = axis_.turns;
    result.origins = axis_.origins;
    result.stems = axis_.stems;
    result.bridges = axis_.bridges;
    result.left_out = axis_.left_out;
    std::vector<Index> renumbered(axis_.size(), kNone);
    for (Index i = 0; i < axis_.size(); ++i) {
      if (!vertex_alive_[i]) continue;
      renumbered[i] = result.size();
      result.centers.push_back(axis_.centers[i]);
      result.radii.push_back(axis_.radii[i]);
      if (!axis_.angles.empty()) result.angles.push_back(axis_.angles[i]);
    }
    for (Index i = 0; i < axis_.size(); ++i) {
      if (!vertex_alive_[i]) continue;
      append(result.forming_points, axis_.forming_points[i]);
      for (const Index edge : complex_.edges_at(i)) {
        const auto [a, b] = complex_.edges()[edge];
        if (edge_alive_[edge]) result.neighbors.items.push_back(renumbered[a == i ? b : a]);
      }
      std::sort(result.neighbors.items.begin() + result.neighbors.offsets.back(), result.neighbors.items.end());
      result.neighbors.close_row();
    }
    for (Index face = 0; face < complex_.face_count(); ++face) {
      if (!face_alive_[face]) continue;
      const bool for_topology = face >= axis_.faces.size();
      Rows& rows = for_topology ? result.topology_faces : result.faces;
      for (const Index corner : complex_.corners(face)) rows.items.push_back(renumbered[corner]);
      rows.close_row();
      (for_topology ? result.topology_face_points : result.face_points).push_back(complex_.points(face));
    }
    return result;
  }
  static void append(Rows& rows, std::span<const Index> row) {
    rows.items.insert(rows.items.end(), row.begin(), row.end());
    rows.close_row();
  }

  const MedialAxis& axis_;
  const CellLimits limits_;
  const AxisComplex complex_;
  const std::vector<double>& over_limit_;
  std::vector<std::uint8_t> vertex_alive_, edge_alive_, face_alive_;
  std::priority_queue<std::pair<double, Cell>> queue_;
};

}  // namespace

MedialAxis prune_cells(const MedialAxis& axis, const CellLimits& limits, const std::vector<double>& over_limit) {
  return Pruner(axis, limits, over_limit).run();
}

}  // namespace orchard::detail
