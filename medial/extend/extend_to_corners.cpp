#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "extend_sheets.h"
#include "orchard/geometry/angle.h"
#include "sharp_ends.h"
#include "sheet_extension.h"

namespace orchard::detail {
namespace {

class CornerReacher {
 public:
  CornerReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : sheets_(surface, complex, options), edges_(surface, *options.features) {}

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
      if (sheets_.complex.balls[v].radius > 0) continue;
      for (const Index e : sheets_.at.edges_at[v]) {
        const Index other = sheets_.other_end(e, v);
        if (sheets_.complex.balls[other].radius > 0) reached_from_[place_of(sheets_.complex.balls[v])].push_back(other);
      }
    }
    std::vector<Way> ways;
    for (Index v = 0; v < before; ++v) {
      const ExactBall& ball = sheets_.complex.balls[v];
      if (on_edges[v].empty() || !ball.exact || ball.count < 3 || ball.radius == 0) continue;
      for (int i = 0; i < ball.count; ++i) {
        for (int j = 0; j < i; ++j) {
          for (int k = 0; k < j; ++k) add_way(v, {i, j, k}, ways);
        }
      }
    }
    std::stable_sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.far < b.far; });
    for (const Way& way : ways) extend(way, on_edges[way.from]);
    sheets_.triangles.finish();
    return sheets_.complex.size() - before;
  }

 private:
  static constexpr double kAside = 20 * std::numbers::pi / 180;  // radians: what is farther beside a way is not on it
  static constexpr double kThere = 1e-3;  // of the way: a vertex as near to a corner is one at the corner

  template <class IsThere>
  Index corner_next_to(Index v, const IsThere& is_there) const {
    if (corner_of_[v] != kNone && is_there(corner_of_[v])) return corner_of_[v];
    for (const Index e : sheets_.at.edges_at[v]) {
      if (is_there(sheets_.other_end(e, v))) return sheets_.other_end(e, v);
    }
    return kNone;
  }

  // The way from the end of a seam to the corner in which those edges meet that the seam's sheets reach.
  struct Way {
    Index from = kNone;
    ExactBall corner;
    double far = 0;
  };

  void add_way(Index v, const std::array<int, 3>& contacts, std::vector<Way>& ways) {
    const ExactBall& ball = sheets_.complex.balls[v];
    Vector to_apex;
    if (!apex_of_three(ball, contacts[0], contacts[1], contacts[2], to_apex)) return;
    const double far = to_apex.norm();
    ClosestPoint foot = ExactBall::nowhere();
    if (far - ball.radius < sheets_.options.level || far > kMaxReach * sheets_.options.spacing) return;
    if (!edges_.nearest_end(ball.center + to_apex, kMaxFoot * far, foot)) return;
    if (!is_way_right(sheets_.surface, ball, foot.position, sheets_.options.tolerance)) return;
    ways.push_back({.from = v, .corner = ball_on_edge(foot), .far = far});
  }

  static std::array<double, 3> place_of(const ExactBall& ball) {
    return {ball.center.x(), ball.center.y(), ball.center.z()};
  }
  bool leads_through(const Way& way, const Point& place) const {
    const Vector to = way.corner.center - sheets_.complex.balls[way.from].center, rest = way.corner.center - place;
    return rest.norm() < to.norm() && angle_between(rest, to) < kAside;
  }

  // Called for the vertices nearest to their corner first. A vertex whose way leads through one of these is not
  // extended: its sheets would fold onto those of the first.
  void extend(const Way& way, const std::vector<Index>& on_edges) {
    const Index v = way.from;
    const ExactBall ball = sheets_.complex.balls[v];
    const auto is_there = [&](Index u) {
      return sheets_.complex.balls[u].radius == 0 &&
             (sheets_.complex.balls[u].center - way.corner.center).norm() < kThere * way.far;
    };
    if (std::any_of(on_edges.begin(), on_edges.end(), is_there)) return;
    Index vertex = corner_next_to(v, is_there);
    std::vector<Index>& others = reached_from_[place_of(way.corner)];
    if (vertex == kNone) {
      const auto is_on_way = [&](Index other) { return leads_through(way, sheets_.complex.balls[other].center); };
      if (std::any_of(others.begin(), others.end(), is_on_way)) return;
      vertex = sheets_.triangles.add_vertex(way.corner);
    }
    corner_of_[v] = vertex;
    others.push_back(v);
    for (const Index u : on_edges) {
      if (is_triangle_right(sheets_.surface, ball, sheets_.complex.balls[u], way.corner, sheets_.options.tolerance))
        sheets_.triangles.add(v, u, vertex);
    }
  }

  SheetExtension sheets_;
  SharpEdges edges_;
  std::vector<Index> corner_of_;                                      // of each vertex: the new one that it goes to
  std::map<std::array<double, 3>, std::vector<Index>> reached_from_;  // of each place on the surface
};

}  // namespace

Index extend_to_corners(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return CornerReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
