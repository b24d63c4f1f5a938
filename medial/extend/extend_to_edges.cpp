#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "extend_sheets.h"
#include "sharp_ends.h"
#include "sheet_extension.h"

namespace orchard::detail {
namespace {

class EdgeReacher {
 public:
  EdgeReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : sheets_(surface, complex, options), edges_(surface, *options.features) {}

  Index run() {
    const Index before = sheets_.complex.size();
    find_ends();
    for (const Index e : sheets_.borders) add_strips(e);
    for (const Index e : sheets_.borders) add_end(e);
    sheets_.triangles.finish();
    return sheets_.complex.size() - before;
  }

 private:
  // The place on an edge of the surface at which a sheet beyond a vertex ends, and the vertex there, once there is one.
  struct End {
    ExactBall ball;
    Index vertex = kNone;
  };

  static constexpr double kMaxAlong =
      3;  // the most that the ends of an edge's vertices may be apart, in (lengths of the edge + spacings)
  static constexpr double kSame = 0.5;  // least cosine of the angle around an edge between two triangles of one sheet

  void find_ends() {
    ends_.resize(sheets_.complex.size());
    std::vector<std::uint8_t> on_border(sheets_.complex.size(), 0);
    for (const Index e : sheets_.borders) {
      for (const Index v : sheets_.complex.edges[e]) on_border[v] = 1;
    }
    tbb::parallel_for(tbb::blocked_range<Index>(0, sheets_.complex.size(), 64), [&](const auto& range) {
      SharpEdges edges(sheets_.surface, *sheets_.options.features);
      for (Index v = range.begin(); v != range.end(); ++v) {
        const ExactBall& ball = sheets_.complex.balls[v];
        if (ball.exact && ball.radius > 0 && on_border[v]) find_ends(ball, edges, ends_[v]);
      }
    });
  }
  void find_ends(const ExactBall& ball, SharpEdges& edges, std::vector<End>& ends) const {
    for (int i = 0; i < ball.count; ++i) {
      for (int k = 0; k < i; ++k) {
        Vector to_apex;
        if (!apex_of_two(ball, i, k, to_apex)) continue;
        const double far = to_apex.norm();
        ClosestPoint foot = ExactBall::nowhere();
        if (far - ball.radius < sheets_.options.level || far > kMaxReach * sheets_.options.spacing) continue;
        if (!edges.nearest(ball.center + to_apex, kMaxFoot * far, foot)) continue;
        const bool known = std::any_of(ends.begin(), ends.end(), [&](const End& end) {
          return (end.ball.center - foot.position).norm() < kMaxFoot * far;
        });
        if (!known && is_way_right(sheets_.surface, ball, foot.position, sheets_.options.tolerance))
          ends.push_back({ball_on_edge(foot), kNone});
      }
    }
  }

  void add_strips(Index e) {
    const auto [a, b] = sheets_.complex.edges[e];
    for (End& x : ends_[a]) {
      End* y = nearest(ends_[b], x);
      if (y != nullptr && nearest(ends_[a], *y) == &x && fits(e, x, *y))
        sheets_.triangles.add_strip(a, b, vertex_of(a, x), vertex_of(b, *y));
    }
  }
  // Adds the triangle at which a row of strips ends. Without a strip beside it, it would be a spike and is not added.
  void add_end(Index e) {
    const auto [a, b] = sheets_.complex.edges[e];
    if (ends_[a].size() + ends_[b].size() != 1 || sheets_.complex.balls[a].radius == 0 ||
        sheets_.complex.balls[b].radius == 0)
      return;
    const End& end = ends_[a].empty() ? ends_[b].front() : ends_[a].front();
    if (end.vertex != kNone && fits(e, end, end)) sheets_.triangles.add(a, b, end.vertex);
  }

  static End* nearest(std::vector<End>& ends, const End& to) {
    const auto apart = [&](const End& end) { return (end.ball.center - to.ball.center).squaredNorm(); };
    const auto found =
        std::min_element(ends.begin(), ends.end(), [&](const End& x, const End& y) { return apart(x) < apart(y); });
    return found == ends.end() ? nullptr : &*found;
  }

  // Whether the strip from an edge to two ends (or one) may be added: its triangles are right, and there is no other
  // triangle of the same sheet.
  bool fits(Index e, const End& x, const End& y) {
    const ExactBall &p = sheets_.complex.balls[sheets_.complex.edges[e][0]],
                    &q = sheets_.complex.balls[sheets_.complex.edges[e][1]];
    const Vector along = q.center - p.center, between = y.ball.center - x.ball.center;
    if (between.norm() > kMaxAlong * (along.norm() + sheets_.options.spacing)) return false;
    if (!edges_.goes_between(x.ball.center, y.ball.center)) return false;
    const Point middle = 0.5 * (p.center + q.center);
    const auto around = [&](const Point& place) -> Vector {
      const Vector from = place - middle;
      return (from - along * (from.dot(along) / along.squaredNorm())).normalized();
    };
    const Vector way = around(0.5 * (x.ball.center + y.ball.center));
    for (const Index t : sheets_.at.triangles_at[e]) {
      for (const Index v : sheets_.complex.triangles[t]) {
        if (v != sheets_.complex.edges[e][0] && v != sheets_.complex.edges[e][1] &&
            way.dot(around(sheets_.complex.balls[v].center)) > kSame)
          return false;
      }
    }
    return is_triangle_right(sheets_.surface, p, x.ball, y.ball, sheets_.options.tolerance) &&
           is_triangle_right(sheets_.surface, q, x.ball, y.ball, sheets_.options.tolerance);
  }

  // The vertex at an end: one that v is joined to if it is there already, else a new one.
  Index vertex_of(Index v, End& end) {
    if (end.vertex != kNone) return end.vertex;
    for (const Index e : sheets_.at.edges_at[v]) {
      const Index other = sheets_.other_end(e, v);
      const ExactBall& ball = sheets_.complex.balls[other];
      if (ball.radius == 0 && (ball.center - end.ball.center).norm() < kMaxFoot * sheets_.complex.balls[v].radius)
        return end.vertex = other;
    }
    return end.vertex = sheets_.triangles.add_vertex(end.ball);
  }

  SheetExtension sheets_;
  SharpEdges edges_;
  std::vector<std::vector<End>> ends_;  // of each vertex
};

}  // namespace

Index extend_to_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return EdgeReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
