#include <algorithm>
#include <utility>
#include <vector>

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
        extension_(complex) {}

  Index run() {
    const Index before = complex_.size();
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
    const bool there = std::any_of(on_edges.begin(), on_edges.end(), [&](Index u) {
      return (complex_.balls[u].center - corner.center).norm() < kThere * far;
    });
    if (there) return;
    const Index vertex = extension_.add_vertex(corner);
    for (const Index u : on_edges) {
      if (is_triangle_right(surface_, ball, complex_.balls[u], corner, options_.tolerance))
        extension_.add(v, u, vertex);
    }
  }

  const Surface& surface_;
  BallComplex& complex_;
  const BorderOptions& options_;
  SharpEdges edges_;
  FreeExtension extension_;
};

}  // namespace

Index extend_to_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return CornerReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
