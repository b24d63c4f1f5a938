#include "border.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <tuple>
#include <unordered_set>

#include "orchard/geometry/angle.h"

namespace orchard::detail {
namespace {

// The triangles of each edge are counted, and what is at the vertices of the borders.
struct Borders {
  std::vector<std::array<Index, 2>> next;  // of each vertex with just two border edges on one sheet: its neighbours
  std::vector<double> inner;               // radians: the sum of the triangles' angles there
  std::vector<std::uint8_t> on_border;     // all that have a border edge
  std::vector<Index> edges;                // those with one triangle
};

double angle_at(const BallComplex& complex, Index at, Index a, Index b) {
  const Point& p = complex.balls[at].center;
  return angle_between(complex.balls[a].center - p, complex.balls[b].center - p);
}

Borders find_borders(const BallComplex& complex) {
  Borders borders;
  std::vector<std::uint8_t> count(complex.edges.size(), 0);
  borders.inner.assign(complex.size(), 0);
  for (const auto& [a, b, c] : complex.triangles) {
    for (const Index edge : {complex.edge_of(a, b), complex.edge_of(a, c), complex.edge_of(b, c)}) {
      if (count[edge] < 3) ++count[edge];
    }
    borders.inner[a] += angle_at(complex, a, b, c);
    borders.inner[b] += angle_at(complex, b, a, c);
    borders.inner[c] += angle_at(complex, c, a, b);
  }
  borders.next.assign(complex.size(), {kNone, kNone});
  borders.on_border.assign(complex.size(), 0);
  std::vector<std::uint8_t> branching(complex.size(), 0);
  for (Index e = 0; e < complex.edges.size(); ++e) {
    const auto& [a, b] = complex.edges[e];
    if (count[e] == 1) borders.edges.push_back(e);
    for (const auto& [v, other] : {std::pair{a, b}, std::pair{b, a}}) {
      if (count[e] == 1) {
        borders.on_border[v] = 1;
        auto& next = borders.next[v];
        if (next[0] == kNone) {
          next[0] = other;
        } else if (next[1] == kNone) {
          next[1] = other;
        } else {
          branching[v] = 1;
        }
      } else if (count[e] != 2) {
        branching[v] = 1;
      }
    }
  }
  for (Index v = 0; v < complex.size(); ++v) {
    if (branching[v] || borders.next[v][1] == kNone) borders.next[v] = {kNone, kNone};
  }
  return borders;
}

class NotchFiller {
 public:
  NotchFiller(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options)
      : surface_(surface), complex_(complex), solver_(solver), options_(options), borders_(find_borders(complex)) {}

  Index run() {
    for (Index v = 0; v < complex_.size(); ++v) offer(v);
    while (!queue_.empty()) {
      const auto [outer, v] = queue_.top();
      queue_.pop();
      if (borders_.next[v][0] != kNone && outer == outer_angle(v)) fill(v);
    }
    const Index count = static_cast<Index>(added_.size());
    complex_.triangles.insert(complex_.triangles.end(), added_.begin(), added_.end());
    if (count > 0) complex_.complete();
    return count;
  }

 private:
  static constexpr double kMaxOuter = 150 * std::numbers::pi / 180;  // wider ones are no notch
  static constexpr double kMaxLength = 4;  // spacings: the third side of a triangle that fills a notch
  static constexpr double kSlack = 4;      // tolerances
  static constexpr double kNear = 0.3;     // of that side: how far the axis may be from its middle

  double outer_angle(Index v) const { return 2 * std::numbers::pi - borders_.inner[v]; }
  void offer(Index v) {
    if (borders_.next[v][0] != kNone && outer_angle(v) < kMaxOuter) queue_.emplace(outer_angle(v), v);
  }
  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
  bool joined(Index a, Index b) const {
    if (new_edges_.contains(key(a, b))) return true;
    return std::binary_search(complex_.edges.begin(), complex_.edges.end(),
                              std::array<Index, 2>{std::min(a, b), std::max(a, b)});
  }
  bool fits(Index v, Index a, Index b) {
    const ExactBall &p = complex_.balls[a], &q = complex_.balls[b];
    const double length = (p.center - q.center).norm();
    if (a == b || joined(a, b) || length > kMaxLength * options_.spacing || !p.exact || !q.exact) return false;
    // What sees each other over the notch, not back over the sheet.
    if (angle_at(complex_, v, a, b) > kMaxOuter + 0.2) return false;
    // Slack: what is a little off is divided later.
    const ExactBall& third = complex_.balls[v];
    const Point centroid = (p.center + q.center + third.center) / 3;
    const auto off = [&](const Point& center, double radius) {
      return ball_error(surface_, center, radius, length) > kSlack * options_.tolerance;
    };
    if (off(centroid, (p.radius + q.radius + third.radius) / 3)) return false;
    if (off((p.center + q.center) / 2, (p.radius + q.radius) / 2)) return false;
    const ExactBall middle = solver_.between(p, q, 0.5);
    return middle.exact && middle.loss >= options_.level / 2 &&
           (middle.center - 0.5 * (p.center + q.center)).norm() <= kNear * length;
  }
  void fill(Index v) {
    const auto [a, b] = borders_.next[v];
    if (!fits(v, a, b)) return;
    added_.push_back({v, a, b});
    new_edges_.insert(key(a, b));
    borders_.next[v] = {kNone, kNone};
    for (const auto& [end, other] : {std::pair{a, b}, std::pair{b, a}}) {
      borders_.inner[end] += angle_at(complex_, end, v, other);
      for (Index& next : borders_.next[end]) {
        if (next == v) next = other;
      }
      offer(end);
    }
  }

  const Surface& surface_;
  BallComplex& complex_;
  BallSolver& solver_;
  const BorderOptions& options_;
  Borders borders_;
  std::vector<std::array<Index, 3>> added_;
  std::unordered_set<std::uint64_t> new_edges_;  // asked only whether it holds a pair
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue_;
};

// Where the sheet at a ball goes on outwards: to the middle of the smallest ball around its contacts.
Vector outward(const ExactBall& ball) {
  Vector best = Vector::Zero();
  double widest = -1;
  for (int i = 0; i < ball.count; ++i) {
    for (int k = 0; k < i; ++k) {
      const double apart = (ball.contacts[i].position - ball.contacts[k].position).norm();
      if (apart <= widest) continue;
      widest = apart;
      best = 0.5 * (ball.contacts[i].position + ball.contacts[k].position) - ball.center;
    }
  }
  if (ball.count < 3) return best;
  const Point& p = ball.contacts[0].position;
  const Vector u = ball.contacts[1].position - p, w = ball.contacts[2].position - p, n = u.cross(w);
  const double uu = u.squaredNorm(), ww = w.squaredNorm(), uw = (u - w).squaredNorm();
  const bool acute = uu + ww > uw && uu + uw > ww && ww + uw > uu;
  if (!acute || !(n.squaredNorm() > 1e-8 * uu * ww)) return best;
  const Point circumcenter = p + (uu * w.cross(n) + ww * n.cross(u)) / (2 * n.squaredNorm());
  return circumcenter - ball.center;
}

class EdgeReacher {
 public:
  EdgeReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : surface_(surface), complex_(complex), options_(options), borders_(find_borders(complex)) {}

  Index run() {
    const Index before = complex_.size();
    extended_.assign(before, kNone);
    for (Index v = 0; v < before; ++v) {
      ExactBall target;
      if (!borders_.on_border[v] || !extend(complex_.balls[v], target)) continue;
      extended_[v] = complex_.size();
      complex_.balls.push_back(target);
    }
    if (complex_.size() == before) return 0;
    for (const Index e : borders_.edges) add_strip(complex_.edges[e][0], complex_.edges[e][1]);
    complex_.complete();
    return complex_.size() - before;
  }

 private:
  static constexpr double kMaxFoot = 0.25;  // of the way to where two planes meet: the distance of the edge from there
  static constexpr double kReach = 4;       // spacings, to an edge

  bool extend(const ExactBall& ball, ExactBall& target) {
    if (!ball.exact || ball.count < 2) return false;
    const Vector way = outward(ball);
    const double length = way.norm();
    if (!(length > 1e-6 * ball.radius)) return false;
    const double apex = ball.radius * (ball.radius / length);  // where the planes at the contacts meet
    return to_edge(ball, ball.center + way * (apex / length), apex, target);
  }

  // The nearest place of a convex edge that is sharp enough; false if there is none within `far`.
  bool sharp_edge_near(const Point& place, double far, ClosestPoint& foot) {
    surface_.triangles_near({place, far}, near_);
    double min = far;
    for (const Index triangle : near_) {
      const auto corners = surface_.corners(triangle);
      for (std::size_t i = 0; i < 3; ++i) {
        const Index other = surface_.neighbors(triangle)[i];
        if (other == kNone || other < triangle) continue;
        const Vector &n = surface_.normal(triangle), &m = surface_.normal(other);
        const Vector edge = corners[(i + 1) % 3] - corners[i];
        if (!(angle_between(n, m) >= options_.sharp_angle) || !(n.cross(m).dot(edge) > 0)) continue;
        const double t = std::clamp((place - corners[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        const Point at = corners[i] + t * edge;
        if (!((at - place).norm() < min)) continue;
        min = (at - place).norm();
        foot = closest_point_of_triangle(at, corners[0], corners[1], corners[2]);
        foot.triangle = triangle;
      }
    }
    return min < far;
  }

  bool to_edge(const ExactBall& ball, const Point& apex, double far, ExactBall& target) {
    if (far > kReach * options_.spacing) return false;
    ClosestPoint foot = ExactBall::nowhere();
    if (!sharp_edge_near(apex, kMaxFoot * far, foot)) return false;
    for (const double t : {0.25, 0.5, 0.75, 0.9}) {
      const Point center = (1 - t) * ball.center + t * foot.position;
      if (ball_error(surface_, center, (1 - t) * ball.radius, far) > options_.tolerance) return false;
    }
    target = {};
    target.center = foot.position;
    target.contacts[0] = foot;
    target.contacts[0].distance = 0;
    target.count = 1;
    target.exact = true;
    target.loss = std::numeric_limits<double>::infinity();
    return true;
  }

  // Between a border edge and what its ends are extended to: the shorter diagonal.
  void add_strip(Index a, Index b) {
    const Index x = extended_[a], y = extended_[b];
    if (x == kNone && y == kNone) return;
    if (x == kNone || y == kNone) {
      complex_.triangles.push_back({a, b, x == kNone ? y : x});
      return;
    }
    const auto apart = [&](Index p, Index q) {
      return (complex_.balls[p].center - complex_.balls[q].center).squaredNorm();
    };
    if (apart(a, y) < apart(b, x)) {
      complex_.triangles.push_back({a, b, y});
      complex_.triangles.push_back({a, y, x});
    } else {
      complex_.triangles.push_back({a, b, x});
      complex_.triangles.push_back({b, y, x});
    }
  }

  const Surface& surface_;
  BallComplex& complex_;
  const BorderOptions& options_;
  Borders borders_;
  std::vector<Index> extended_, near_;
};

}  // namespace

Index fill_notches(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options) {
  return NotchFiller(surface, complex, solver, options).run();
}

Index extend_to_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return EdgeReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
