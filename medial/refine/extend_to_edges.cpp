#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "../axis/incidence.h"
#include "extend_sheets.h"
#include "free_extension.h"
#include "sharp_ends.h"

namespace orchard::detail {
namespace {

class EdgeReacher {
 public:
  EdgeReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : surface_(surface),
        complex_(complex),
        options_(options),
        at_(complex.edges, complex.triangles, complex.size()),
        extension_(complex) {}

  Index run() {
    const Index before = complex_.size();
    find_ends();
    for (const Index e : borders_) add_strips(e);
    for (const Index e : borders_) add_end(e);
    extension_.finish();
    return complex_.size() - before;
  }

 private:
  // Where a sheet at a vertex ends: the place, and its vertex once there is one.
  struct End {
    ExactBall ball;
    Index vertex = kNone;
  };

  static constexpr double kMaxAlong = 3;  // lengths of an edge, and as many spacings: between the ends of its vertices
  static constexpr double kSame = 0.5;    // cosine of the angle around an edge between two triangles of one sheet

  void find_ends() {
    ends_.resize(complex_.size());
    std::vector<std::uint8_t> on_border(complex_.size(), 0);
    for (Index e = 0; e < at_.triangles_at.size(); ++e) {
      if (at_.triangles_at[e].size() != 1) continue;
      borders_.push_back(e);
      for (const Index v : complex_.edges[e]) on_border[v] = 1;
    }
    tbb::parallel_for(tbb::blocked_range<Index>(0, complex_.size(), 64), [&](const auto& range) {
      SharpEdges edges(surface_, options_.sharp_angle);
      for (Index v = range.begin(); v != range.end(); ++v) {
        const ExactBall& ball = complex_.balls[v];
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
        if (far - ball.radius < options_.level || far > kMaxReach * options_.spacing) continue;
        if (!edges.nearest(ball.center + to_apex, kMaxFoot * far, foot)) continue;
        const bool known = std::any_of(ends.begin(), ends.end(), [&](const End& end) {
          return (end.ball.center - foot.position).norm() < kMaxFoot * far;
        });
        if (!known && is_way_right(surface_, ball, foot.position, options_.tolerance))
          ends.push_back({ball_on_edge(foot), kNone});
      }
    }
  }

  void add_strips(Index e) {
    const auto [a, b] = complex_.edges[e];
    for (End& x : ends_[a]) {
      End* y = nearest(ends_[b], x);
      if (y != nullptr && nearest(ends_[a], *y) == &x && fits(e, x, *y))
        extension_.add_strip(a, b, vertex_of(a, x), vertex_of(b, *y));
    }
  }
  // A triangle where a row of strips ends; alone it would be a spike.
  void add_end(Index e) {
    const auto [a, b] = complex_.edges[e];
    if (ends_[a].size() + ends_[b].size() != 1 || complex_.balls[a].radius == 0 || complex_.balls[b].radius == 0)
      return;
    const End& end = ends_[a].empty() ? ends_[b].front() : ends_[a].front();
    if (end.vertex != kNone && fits(e, end, end)) extension_.add(a, b, end.vertex);
  }

  static End* nearest(std::vector<End>& ends, const End& to) {
    const auto apart = [&](const End& end) { return (end.ball.center - to.ball.center).squaredNorm(); };
    const auto found =
        std::min_element(ends.begin(), ends.end(), [&](const End& x, const End& y) { return apart(x) < apart(y); });
    return found == ends.end() ? nullptr : &*found;
  }

  // Whether the strip from an edge to two ends, or one, is right, and its sheet not there yet.
  bool fits(Index e, const End& x, const End& y) const {
    const ExactBall &p = complex_.balls[complex_.edges[e][0]], &q = complex_.balls[complex_.edges[e][1]];
    const Vector along = q.center - p.center, between = y.ball.center - x.ball.center;
    if (between.norm() > kMaxAlong * (along.norm() + options_.spacing)) return false;
    const Point middle = 0.5 * (p.center + q.center);
    const auto around = [&](const Point& place) -> Vector {
      const Vector from = place - middle;
      return (from - along * (from.dot(along) / along.squaredNorm())).normalized();
    };
    const Vector way = around(0.5 * (x.ball.center + y.ball.center));
    for (const Index t : at_.triangles_at[e]) {
      for (const Index v : complex_.triangles[t]) {
        if (v != complex_.edges[e][0] && v != complex_.edges[e][1] && way.dot(around(complex_.balls[v].center)) > kSame)
          return false;
      }
    }
    return is_triangle_right(surface_, p, x.ball, y.ball, options_.tolerance) &&
           is_triangle_right(surface_, q, x.ball, y.ball, options_.tolerance);
  }

  // One that is there already, if v is joined to it.
  Index vertex_of(Index v, End& end) {
    if (end.vertex != kNone) return end.vertex;
    for (const Index e : at_.edges_at[v]) {
      const Index other = complex_.edges[e][0] == v ? complex_.edges[e][1] : complex_.edges[e][0];
      const ExactBall& ball = complex_.balls[other];
      if (ball.radius == 0 && (ball.center - end.ball.center).norm() < kMaxFoot * complex_.balls[v].radius)
        return end.vertex = other;
    }
    return end.vertex = extension_.add_vertex(end.ball);
  }

  const Surface& surface_;
  BallComplex& complex_;
  const BorderOptions& options_;
  const CellIncidence at_;
  FreeExtension extension_;
  std::vector<Index> borders_;          // edges
  std::vector<std::vector<End>> ends_;  // of each vertex
};

}  // namespace

Index extend_to_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return EdgeReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
