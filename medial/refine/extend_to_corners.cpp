#include <algorithm>
#include <utility>
#include <vector>

#include "extend_sheets.h"
#include "sharp_ends.h"
#include "sheet_extension.h"

namespace orchard::detail {
namespace {

class CornerReacher {
 public:
  CornerReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : sheets_(surface, complex, options), edges_(surface, options.sharp_angle) {}

  Index run() {
    const Index before = sheets_.complex.size();
    corner_of_.assign(before, kNone);
    std::vector<std::vector<Index>> on_edges(before);  // of each vertex: those of radius 0 that its borders go to
    for (const Index e : sheets_.borders) {
      const auto& [a, b] = sheets_.complex.edges[e];
      if (sheets_.complex.balls[a].radius == 0) on_edges[b].push_back(a);
      if (sheets_.complex.balls[b].radius == 0) on_edges[a].push_back(b);
    }
    for (Index v = 0; v < before; ++v) {
      const ExactBall ball = sheets_.complex.balls[v];
      if (on_edges[v].empty() || !ball.exact || ball.count < 3 || ball.radius == 0) continue;
      for (int i = 0; i < ball.count; ++i) {
        for (int j = 0; j < i; ++j) {
          for (int k = 0; k < j; ++k) extend(v, {i, j, k}, on_edges[v]);
        }
      }
    }
    sheets_.triangles.finish();
    return sheets_.complex.size() - before;
  }

 private:
  static constexpr double kThere = 1e-3;  // of the way: a vertex as near to a corner is one at the corner

  template <class IsThere>
  Index corner_next_to(Index v, const IsThere& is_there) const {
    if (corner_of_[v] != kNone && is_there(corner_of_[v])) return corner_of_[v];
    for (const Index e : sheets_.at.edges_at[v]) {
      if (is_there(sheets_.other_end(e, v))) return sheets_.other_end(e, v);
    }
    return kNone;
  }

  void extend(Index v, const std::array<int, 3>& contacts, const std::vector<Index>& on_edges) {
    const ExactBall ball = sheets_.complex.balls[v];
    Vector to_apex;
    if (!apex_of_three(ball, contacts[0], contacts[1], contacts[2], to_apex)) return;
    const double far = to_apex.norm();
    ClosestPoint foot = ExactBall::nowhere();
    if (far - ball.radius < sheets_.options.level || far > kMaxReach * sheets_.options.spacing) return;
    if (!edges_.nearest_end(ball.center + to_apex, kMaxFoot * far, foot)) return;
    if (!is_way_right(sheets_.surface, ball, foot.position, sheets_.options.tolerance)) return;
    const ExactBall corner = ball_on_edge(foot);
    const auto is_there = [&](Index u) {
      return sheets_.complex.balls[u].radius == 0 &&
             (sheets_.complex.balls[u].center - corner.center).norm() < kThere * far;
    };
    if (std::any_of(on_edges.begin(), on_edges.end(), is_there)) return;
    Index vertex = corner_next_to(v, is_there);
    for (const Index e : sheets_.at.edges_at[v]) {
      if (vertex != kNone) break;
      // Next to a neighbour: by way of a triangle with that one.
      const Index other = sheets_.other_end(e, v), found = corner_next_to(other, is_there);
      const bool is_way =
          found != kNone && sheets_.complex.balls[other].radius > 0 &&
          is_triangle_right(sheets_.surface, ball, sheets_.complex.balls[other], corner, sheets_.options.tolerance);
      if (is_way && sheets_.triangles.add(v, other, found)) vertex = found;
    }
    if (vertex == kNone) vertex = sheets_.triangles.add_vertex(corner);
    corner_of_[v] = vertex;
    for (const Index u : on_edges) {
      if (is_triangle_right(sheets_.surface, ball, sheets_.complex.balls[u], corner, sheets_.options.tolerance))
        sheets_.triangles.add(v, u, vertex);
    }
  }

  SheetExtension sheets_;
  SharpEdges edges_;
  std::vector<Index> corner_of_;  // of each vertex: the new one that it goes to
};

}  // namespace

Index extend_to_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return CornerReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
