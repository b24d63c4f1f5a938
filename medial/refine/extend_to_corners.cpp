#include <algorithm>
#include <utility>
#include <vector>

#include "../axis/incidence.h"
#include "extend_sheets.h"
#include "free_extension.h"
#include "sharp_ends.h"

namespace orchard::detail {
namespace {

class CornerReacher {
 public:
  CornerReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : surface_(surface),
        complex_(complex),
        options_(options),
        edges_(surface, options.sharp_angle),
        at_(complex.edges, complex.triangles, complex.size()),
        extension_(complex) {}

  Index run() {
    const Index before = complex_.size();
    corner_of_.assign(before, kNone);
    std::vector<std::vector<Index>> on_edges(before);  // of each vertex: those of radius 0 that its borders go to
    for (const Index e : find_borders(complex_).edges) {
      const auto& [a, b] = complex_.edges[e];
      if (complex_.balls[a].radius == 0) on_edges[b].push_back(a);
      if (complex_.balls[b].radius == 0) on_edges[a].push_back(b);
    }
    for (Index v = 0; v < before; ++v) {
      const ExactBall ball = complex_.balls[v];
      if (on_edges[v].empty() || !ball.exact || ball.count < 3 || ball.radius == 0) continue;
      for (int i = 0; i < ball.count; ++i) {
        for (int j = 0; j < i; ++j) {
          for (int k = 0; k < j; ++k) extend(v, {i, j, k}, on_edges[v]);
        }
      }
    }
    extension_.finish();
    return complex_.size() - before;
  }

 private:
  static constexpr double kThere = 1e-3;  // of the way: a vertex as near to a corner is one at the corner

  Index other_end(Index e, Index v) const {
    return complex_.edges[e][0] == v ? complex_.edges[e][1] : complex_.edges[e][0];
  }
  template <class IsThere>
  Index corner_next_to(Index v, const IsThere& is_there) const {
    if (corner_of_[v] != kNone && is_there(corner_of_[v])) return corner_of_[v];
    for (const Index e : at_.edges_at[v]) {
      if (is_there(other_end(e, v))) return other_end(e, v);
    }
    return kNone;
  }

  void extend(Index v, const std::array<int, 3>& contacts, const std::vector<Index>& on_edges) {
    const ExactBall ball = complex_.balls[v];
    Vector to_apex;
    if (!apex_of_three(ball, contacts[0], contacts[1], contacts[2], to_apex)) return;
    const double far = to_apex.norm();
    ClosestPoint foot = ExactBall::nowhere();
    if (far - ball.radius < options_.level || far > kMaxReach * options_.spacing) return;
    if (!edges_.nearest_end(ball.center + to_apex, kMaxFoot * far, foot)) return;
    if (!is_way_right(surface_, ball, foot.position, options_.tolerance)) return;
    const ExactBall corner = ball_on_edge(foot);
    const auto is_there = [&](Index u) {
      return complex_.balls[u].radius == 0 && (complex_.balls[u].center - corner.center).norm() < kThere * far;
    };
    if (std::any_of(on_edges.begin(), on_edges.end(), is_there)) return;
    Index vertex = corner_next_to(v, is_there);
    for (const Index e : at_.edges_at[v]) {
      if (vertex != kNone) break;
      // Next to a neighbour: by way of a triangle with that one.
      const Index other = other_end(e, v), found = corner_next_to(other, is_there);
      const bool is_way = found != kNone && complex_.balls[other].radius > 0 &&
                          is_triangle_right(surface_, ball, complex_.balls[other], corner, options_.tolerance);
      if (is_way && extension_.add(v, other, found)) vertex = found;
    }
    if (vertex == kNone) vertex = extension_.add_vertex(corner);
    corner_of_[v] = vertex;
    for (const Index u : on_edges) {
      if (is_triangle_right(surface_, ball, complex_.balls[u], corner, options_.tolerance))
        extension_.add(v, u, vertex);
    }
  }

  const Surface& surface_;
  BallComplex& complex_;
  const BorderOptions& options_;
  SharpEdges edges_;
  const CellIncidence at_;
  FreeExtension extension_;
  std::vector<Index> corner_of_;  // of each vertex: the new one that it goes to
};

}  // namespace

Index extend_to_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return CornerReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
