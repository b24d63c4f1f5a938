#include "reach_open_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "../balls/split.h"
#include "../extend/flat_triangle.h"
#include "../extend/growing_borders.h"
#include "../extend/point_grid.h"
#include "../extend/sharp_ends.h"
#include "../extend/sheet_extension.h"
#include "../quality/reconstruction.h"
#include "on_sheet.h"

namespace orchard::detail {
namespace {

class OpenPlaceReacher {
 public:
  OpenPlaceReacher(const Surface& surface, BallComplex& complex, BallSolver& solver,
                   const Reconstruction& reconstruction, double left, const BorderOptions& options,
                   const SplitOptions& dividing)
      : sheets_(surface, complex, options),
        borders_(sheets_, kBeside * options.spacing),
        edge_numbers_(complex.edge_numbers()),
        solver_(solver),
        edges_(surface, *options.features),
        reconstruction_(reconstruction),
        left_(left),
        dividing_(dividing) {}

  // Reaches the places. From each reached place it continues with the nearest ones, so that places along a ridge get
  // one sheet.
  Index run(std::span<const UncoveredPlace> places) {
    const double beside = kBeside * sheets_.options.spacing;
    PointGrid grid(beside);
    for (Index i = 0; i < places.size(); ++i) grid.add(places[i].position, i);
    std::vector<std::uint8_t> done(places.size(), 0);
    using Next = std::pair<double, Index>;
    std::priority_queue<Next, std::vector<Next>, std::greater<>> next;
    Index reached = 0;
    for (Index first = 0; first < places.size(); ++first) {
      next.emplace(0, first);
      while (!next.empty()) {
        const Index i = next.top().second;
        next.pop();
        if (std::exchange(done[i], 1) != 0 || !reach(places[i])) continue;
        ++reached;
        grid.visit_near(places[i].position, [&](Index k) {
          const double apart = (places[k].position - places[i].position).norm();
          if (apart <= beside && done[k] == 0) next.emplace(apart, k);
        });
      }
    }
    sheets_.triangles.finish();
    return reached;
  }

 private:
  static constexpr double kSlack = 1.15;     // a ball may leave this many times the aimed value open
  static constexpr double kTouching = 1e-3;  // the surface may be this far inside a ball, in radii
  static constexpr int kSteps = 20;          // steps of bisection and of shrinking
  static constexpr int kAttempts = 4;        // each starts half as far inside as the last one
  static constexpr int kProbed = 4;     // the parts of a side at which balls between an edge and a new ball are tested
  static constexpr double kBeside = 8;  // the largest distance of a place from its border edge, in spacings
  static constexpr double kAt = 1e-9;   // bounding radii: how far rounding moves a place off a vertex or an edge

  bool reach(const UncoveredPlace& place) {
    const Reconstruction::Nearest nearest = reconstruction_.nearest(place.inside);
    const Point& foot = nearest.ball.center;
    const std::vector<Index> candidates = edges_at(reconstruction_.corners_of(nearest.cell), foot);
    if (candidates.empty()) return false;
    ClosestPoint on_edge = ExactBall::nowhere();
    const ExactBall ball =
        edges_.nearest(place.position, left_, on_edge) ? ball_on_edge(on_edge) : ball_at(place.position, foot, left_);
    const Index end = end_of_curve(reconstruction_.corners_of(nearest.cell), foot);
    if (end != kNone && attach_to_curve(ball, end)) return true;
    if (attach_beside(ball) || attach(ball, candidates)) return true;
    // If no triangle can reach the aim, one may reach half of it, or start farther back.
    const ExactBall half = ball_at(place.position, foot, place.value / 2);
    const std::vector<Index> around = edges_around(reconstruction_.corners_of(nearest.cell));
    if (attach(half, candidates) || attach(ball, around) || attach(half, around)) return true;
    // A ball beside the axis, which counts as inexact, is better than a hole.
    const ExactBall beside = solver_.at(on_way(place.position, foot, left_));
    return attach(beside, candidates) || attach(beside, around);
  }

  bool attach(const ExactBall& ball, std::vector<Index> candidates) {
    if (ball.count == 0) return false;
    const auto value = [&](Index e) {
      return std::pair(sheets_.at.triangles_at[e].size() == 1 ? 0 : 1, apart(ball.center, e));
    };
    std::stable_sort(candidates.begin(), candidates.end(), [&](Index a, Index b) { return value(a) < value(b); });
    Index vertex = kNone;
    for (const Index e : candidates) {
      const auto& [a, b] = sheets_.complex.edges[e];
      if (vertex != kNone && sheets_.at.triangles_at[e].size() != 1) break;
      if (!fits(a, b, ball)) continue;
      const Index v = vertex == kNone ? sheets_.triangles.add_vertex(ball) : vertex;
      if (!add({a, b}, v)) continue;
      vertex = v;
    }
    return vertex != kNone;
  }

  // Returns the free end of a curve at the foot of a place, as below the tip of a cone; kNone if there is none, or if
  // the curve was already continued from there.
  Index end_of_curve(const std::array<Index, 3>& cell, const Point& foot) const {
    if (cell[1] != cell[2]) return kNone;
    const double at = kAt * sheets_.surface.bounding_radius();
    for (const Index v : cell) {
      if ((sheets_.complex.balls[v].center - foot).norm() > at || sheets_.at.edges_at[v].size() > 1) continue;
      return std::find(continued_.begin(), continued_.end(), v) == continued_.end() ? v : kNone;
    }
    return kNone;
  }

  // Continues a curve by an edge from its end to the ball. Triangles would have no area there.
  bool attach_to_curve(const ExactBall& ball, Index end) {
    if (ball.count == 0) return false;
    const ExactBall& last = sheets_.complex.balls[end];
    for (int i = 1; i < kProbed; ++i) {
      const double t = static_cast<double>(i) / kProbed;
      const double radius = (1 - t) * last.radius + t * ball.radius;
      const Point center = (1 - t) * last.center + t * ball.center;
      if (radius + sheets_.surface.signed_distance(center) > kBorderSlack * sheets_.options.tolerance) return false;
    }
    if (!sheets_.triangles.add_edge(end, sheets_.triangles.add_vertex(ball))) return false;
    continued_.push_back(end);
    return true;
  }

  // Adds a triangle from the border edge with which the borders become longer by the least, and a triangle for each of
  // its free sides that closes a corner with another border. From edges farther inside, each place would get a spike of
  // its own with two long borders.
  bool attach_beside(const ExactBall& ball) {
    if (ball.count == 0) return false;
    const std::vector<std::array<Index, 2>> near = borders_.near(ball.center);
    const auto grows = [&](const auto& edge) { return may_grow(edge[0], edge[1], ball); };
    const auto first = std::find_if(near.begin(), near.end(), grows);
    if (first == near.end()) return false;
    const Index v = sheets_.triangles.add_vertex(ball);
    add(*first, v);
    const auto closes = [&](const std::array<Index, 2>& edge) {
      const auto& [a, b] = edge;
      return borders_.has(edge) && (borders_.has({a, v}) || borders_.has({b, v})) && grows(edge);
    };
    for (int side = 0; side < 2; ++side) {
      const auto next = std::find_if(near.begin(), near.end(), closes);
      if (next == near.end() || !add(*next, v)) break;
    }
    return true;
  }
  bool add(const std::array<Index, 2>& edge, Index v) {
    if (!sheets_.triangles.add(edge[0], edge[1], v)) return false;
    borders_.add(edge[0], edge[1], v);
    return true;
  }

  // Returns whether a triangle from a border edge, with its nearer end first, can be divided until it is right. At
  // sharp edges of the mesh, it has to run along these.
  bool may_grow(Index a, Index b, const ExactBall& ball) {
    const ExactBall &p = sheets_.complex.balls[a], &q = sheets_.complex.balls[b];
    if (p.radius == 0 && q.radius == 0) return false;
    if (p.radius == 0 && ball.radius == 0 && !edges_.goes_between(p.center, ball.center)) return false;
    return fits(a, b, ball) && becomes_linear(sheets_.surface, p, q, ball, dividing_);
  }

  // Returns the centre, on the way from a place to the centre of its nearest ball, of the largest ball that leaves the
  // place open by at most `left`. Balls farther inside leave more open.
  Point on_way(const Point& place, const Point& inside, double left) const {
    const double length = (inside - place).norm();
    double from = 0, to = 1;
    for (int step = 0; step < kSteps; ++step) {
      const double t = 0.5 * (from + to);
      (t * length - sheets_.surface.distance(place + t * (inside - place)) > left ? to : from) = t;
    }
    return place + from * (inside - place);
  }

  // Returns an exact ball that leaves a place open by about `left` at most; one without contacts if none is found.
  ExactBall ball_at(const Point& place, const Point& inside, double left) {
    const Vector way = on_way(place, inside, left) - place;
    double part = 1;
    for (int attempt = 0; attempt < kAttempts; ++attempt, part /= 2) {
      const Point start = place + part * way;
      ExactBall ball = ball_touching(sheets_.surface.closest(start), start);
      if (ball.exact && (ball.center - place).norm() - ball.radius <= kSlack * left) return ball;
    }
    return {};
  }

  // Returns the ball of the medial axis that touches at a contact, on the side of `start`. A ball that is too large
  // shrinks until it contains no part of the surface.
  ExactBall ball_touching(const ClosestPoint& contact, const Point& start) {
    if (!(contact.distance > 0)) return {};
    const Vector inward = (start - contact.position) / contact.distance;
    double radius = 2 * sheets_.surface.bounding_radius();
    ClosestPoint other = contact;
    for (int step = 0; step < kSteps; ++step) {
      const ClosestPoint nearest = sheets_.surface.closest(contact.position + radius * inward);
      if (nearest.distance >= radius * (1 - kTouching)) break;
      const Vector to = nearest.position - contact.position;
      const double across = to.dot(inward);
      if (!(across > 0)) return {};
      other = nearest;
      radius = to.squaredNorm() / (2 * across);
    }
    const std::array<ClosestPoint, 2> seeds{contact, other};
    const ExactBall ball = solver_.solve(contact.position + radius * inward, seeds);
    return sheets_.surface.inside(ball.center) ? ball : ExactBall{};  // where a mesh cuts itself, it may be outside
  }

  // Returns the edges of a cell on which a place lies, or all its edges if it lies on none.
  std::vector<Index> edges_at(const std::array<Index, 3>& cell, const Point& place) const {
    const double at = kAt * sheets_.surface.bounding_radius();
    std::vector<Index> edges;
    for (const Index v : cell) {
      if ((sheets_.complex.balls[v].center - place).norm() > at) continue;
      const auto row = sheets_.at.edges_at[v];
      return {row.begin(), row.end()};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (cell[i] == cell[(i + 1) % 3]) continue;
      const Index e = edge_numbers_(cell[i], cell[(i + 1) % 3]);
      if (apart(place, e) <= at) return {e};
      edges.push_back(e);
    }
    return edges;
  }

  // Returns all edges at the corners of a cell, each once.
  std::vector<Index> edges_around(const std::array<Index, 3>& cell) const {
    std::vector<Index> edges;
    for (const Index v : cell) {
      const auto row = sheets_.at.edges_at[v];
      edges.insert(edges.end(), row.begin(), row.end());
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  double apart(const Point& place, Index e) const {
    const Point &a = sheets_.complex.balls[sheets_.complex.edges[e][0]].center,
                &b = sheets_.complex.balls[sheets_.complex.edges[e][1]].center;
    const Vector along = b - a;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp(along.dot(place - a) / squared, 0.0, 1.0) : 0;
    return (place - a - t * along).norm();
  }

  // Returns whether there are balls between an edge and a new ball that protrude only a little, where no sheet is yet.
  bool fits(Index a, Index b, const ExactBall& ball) const {
    const ExactBall &p = sheets_.complex.balls[a], &q = sheets_.complex.balls[b];
    // Triangles without area or without balls are refused.
    if (is_flat_triangle(p.center, q.center, ball.center) || std::max({p.radius, q.radius, ball.radius}) == 0)
      return false;
    const auto protrudes = [&](double u, double v, double w) {
      const double radius = u * p.radius + v * q.radius + w * ball.radius;
      return radius + sheets_.surface.signed_distance(u * p.center + v * q.center + w * ball.center) >
             kBorderSlack * sheets_.options.tolerance;
    };
    for (int i = 1; i < kProbed; ++i) {
      for (int k = 0; k <= i; ++k) {
        const auto part = [](int n) { return static_cast<double>(n) / kProbed; };
        if (protrudes(part(k), part(i - k), part(kProbed - i))) return false;
      }
    }
    return !lies_on_sheet(sheets_.surface, reconstruction_, p.center, q.center, ball.center);
  }

  SheetExtension sheets_;
  GrowingBorders borders_;
  const EdgeNumbers edge_numbers_;  // of the edges before this object added any
  BallSolver& solver_;
  SharpEdges edges_;
  const Reconstruction& reconstruction_;
  const double left_;             // mesh units: how far a new ball leaves its place open
  std::vector<Index> continued_;  // the ends of curves that were continued
  const SplitOptions& dividing_;
};

}  // namespace

Index reach_open_places(const Surface& surface, BallComplex& complex, BallSolver& solver,
                        const Reconstruction& reconstruction, std::span<const UncoveredPlace> places, double left,
                        const BorderOptions& options, const SplitOptions& dividing) {
  return OpenPlaceReacher(surface, complex, solver, reconstruction, left, options, dividing).run(places);
}

}  // namespace orchard::detail
