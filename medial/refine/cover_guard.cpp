#include "cover_guard.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "../quality/reconstruction.h"

namespace orchard::detail {
namespace {

// Makes a mesh of some cells of a complex. Only their vertices are taken, because a vertex without a cell would count
// as a ball.
class PartialMesh {
 public:
  explicit PartialMesh(const BallComplex& complex) : complex_(complex), number_(complex.size(), kNone) {}

  void add(const std::array<Index, 2>& edge) { mesh_.edges.push_back({number(edge[0]), number(edge[1])}); }
  void add(const std::array<Index, 3>& t) { mesh_.triangles.push_back({number(t[0]), number(t[1]), number(t[2])}); }
  void add(Index vertex) { number(vertex); }

  // To be called when all cells have been added.
  const MedialMesh& finish() {
    for (auto& edge : mesh_.edges) std::sort(edge.begin(), edge.end());
    for (auto& triangle : mesh_.triangles) std::sort(triangle.begin(), triangle.end());
    complete(mesh_);
    return mesh_;
  }
  Index vertex_of_complex(Index v) const { return vertices_[v]; }

 private:
  Index number(Index v) {
    if (number_[v] != kNone) return number_[v];
    vertices_.push_back(v);
    mesh_.centers.push_back(complex_.balls[v].center);
    mesh_.radii.push_back(complex_.balls[v].radius);
    return number_[v] = static_cast<Index>(vertices_.size() - 1);
  }

  const BallComplex& complex_;
  std::vector<Index> number_, vertices_;
  MedialMesh mesh_;
};

Index piece_of(const std::array<Index, 3>& t, const EdgeNumbers& edge, const std::vector<Index>& piece_of_edge) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Index a = t[k], b = t[(k + 1) % 3];
    if (a == b) continue;
    if (const Index piece = piece_of_edge[edge(a, b)]; piece != kNone) return piece;
  }
  return kNone;
}

std::vector<Index> lone_vertices(const BallComplex& complex) {
  std::vector<std::uint8_t> has_edge(complex.size(), 0);
  for (const auto& [a, b] : complex.edges) has_edge[a] = has_edge[b] = 1;
  std::vector<Index> lone;
  for (Index v = 0; v < complex.size(); ++v) {
    if (has_edge[v] == 0) lone.push_back(v);
  }
  return lone;
}

// For each piece, a box around the places near it.
class Reach {
 public:
  Reach(std::span<const Point> places, const std::vector<Index>& piece_near, double limit) {
    std::map<Index, Box> of_piece;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (piece_near[i] != kNone) of_piece[piece_near[i]].extend(places[i]);
    }
    for (const auto& [piece, box] : of_piece) {
      const Vector beyond = Vector::Constant(limit);
      boxes_.emplace_back(box.min() - beyond, box.max() + beyond);
    }
  }

  bool empty() const { return boxes_.empty(); }
  // Whether a ball interpolated on these balls may be within the limit of a place.
  template <class Corners>
  bool holds(const BallComplex& complex, const Corners& corners) const {
    Box cell;
    for (const Index v : corners) {
      const ExactBall& ball = complex.balls[v];
      const Vector radius = Vector::Constant(ball.radius);
      cell.extend(Box(ball.center - radius, ball.center + radius));
    }
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& box) { return box.intersects(cell); });
  }

 private:
  std::vector<Box> boxes_;
};

}  // namespace

std::vector<std::uint8_t> CoverGuard::needed(const BallComplex& complex,
                                             const std::vector<Index>& piece_of_edge) const {
  std::vector<std::uint8_t> needed(std::max(complex.edges.size(), complex.triangles.size()), 0);
  if (std::all_of(piece_of_edge.begin(), piece_of_edge.end(), [](Index piece) { return piece == kNone; }))
    return needed;
  const EdgeNumbers edge = complex.edge_numbers();
  PartialMesh goes(complex);
  for (Index e = 0; e < complex.edges.size(); ++e) {
    if (piece_of_edge[e] != kNone) goes.add(complex.edges[e]);
  }
  std::vector<Index> piece_of_triangle;
  piece_of_triangle.reserve(complex.triangles.size());
  for (const auto& t : complex.triangles) {
    piece_of_triangle.push_back(piece_of(t, edge, piece_of_edge));
    if (piece_of_triangle.back() != kNone) goes.add(t);
  }
  const Reconstruction pieces(goes.finish());
  std::vector<Index> piece_near(places_.size(), kNone);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places_.size(), 128), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const Reconstruction::Nearest nearest = pieces.nearest(places_[i]);
      if (nearest.distance > limit_) continue;
      std::array<Index, 3> corners = pieces.corners_of(nearest.cell);
      for (Index& v : corners) v = goes.vertex_of_complex(v);
      piece_near[i] = piece_of(corners, edge, piece_of_edge);
    }
  });

  // Of the cells that stay, only those that may be in reach of these places are used.
  const Reach reach(places_, piece_near, limit_);
  if (reach.empty()) return needed;
  PartialMesh stays(complex);
  for (Index e = 0; e < complex.edges.size(); ++e) {
    if (piece_of_edge[e] == kNone && reach.holds(complex, complex.edges[e])) stays.add(complex.edges[e]);
  }
  for (Index t = 0; t < complex.triangles.size(); ++t) {
    if (piece_of_triangle[t] == kNone && reach.holds(complex, complex.triangles[t])) stays.add(complex.triangles[t]);
  }
  for (const Index v : lone_vertices(complex)) stays.add(v);
  const MedialMesh& rest = stays.finish();
  const Reconstruction without(rest);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (piece_near[i] == kNone || needed[piece_near[i]] != 0) continue;
    const bool is_covered = rest.size() > 0 && without.nearest(places_[i], limit_).distance <= limit_;
    if (!is_covered) needed[piece_near[i]] = 1;
  }
  return needed;
}

}  // namespace orchard::detail
