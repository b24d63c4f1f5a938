#include "drop_doubled.h"

#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "../axis/incidence.h"
#include "../quality/reconstruction.h"
#include "../quality/support_tree.h"

namespace orchard::detail {
namespace {

constexpr double kAhead = 3;  // gains, by which borders may become longer before they become shorter

class DoubledDropper {
 public:
  DoubledDropper(BallComplex& complex, double apart, double gain)
      : complex_(complex),
        apart_(apart),
        gain_(gain),
        at_(complex.edges, complex.triangles, complex.size()),
        tree_(corners(complex)),
        alive_{std::vector<std::uint8_t>(complex.size(), 1), std::vector<std::uint8_t>(complex.edges.size(), 1),
               std::vector<std::uint8_t>(complex.triangles.size(), 1)},
        held_(complex.triangles.size()),
        tried_(complex.edges.size(), 0) {}

  Index run() {
    Index dropped = 0;
    for (const Index e : at_.border_edges()) {
      if (!tried_[e]) dropped += drop_from(e);
    }
    if (dropped > 0) keep_alive(complex_, alive_);
    return dropped;
  }

 private:
  // A triangle that has gone, with what was free of it.
  struct Taken {
    Index triangle = kNone;
    std::array<Index, 2> edges{kNone, kNone};
    Index vertex = kNone;
    std::vector<Index> holders;  // triangles, of each ball that it held
    double border = 0;           // mesh units, by how much the borders are longer than before the first one
  };

  static std::vector<SupportTree::Item> corners(const BallComplex& complex) {
    const auto of = [&](Index v) { return Sphere{complex.balls[v].center, complex.balls[v].radius}; };
    std::vector<SupportTree::Item> items;
    items.reserve(complex.triangles.size());
    for (const auto& [a, b, c] : complex.triangles) items.push_back({of(a), of(b), of(c)});
    return items;
  }

  double length(Index e) const {
    const auto& [a, b] = complex_.edges[e];
    return (complex_.balls[a].center - complex_.balls[b].center).norm();
  }
  int triangles_at(Index e) const {
    int count = 0;
    for (const Index t : at_.triangles_at[e]) count += alive_.triangles[t];
    return count;
  }
  bool is_border(Index e) const { return alive_.edges[e] != 0 && triangles_at(e) == 1; }
  // Mesh units: by how much the borders are longer without a triangle.
  double longer_without(Index t) const {
    double longer = 0;
    for (const Index side : at_.sides[t]) {
      const int triangles = triangles_at(side);
      if (triangles < 3) longer += (triangles == 1 ? -1 : 1) * length(side);
    }
    return longer;
  }

  // From one border edge on takes those triangles first that make the borders shortest, unless they become longer by
  // too much; what does not pay in the end comes back, and is not tried again from other edges.
  Index drop_from(Index border_edge) {
    std::vector<Taken> taken;
    using Next = std::pair<double, Index>;  // by how much the borders will be longer, border edge
    std::priority_queue<Next, std::vector<Next>, std::greater<>> front;
    const auto offer = [&](Index e) {
      if (is_border(e)) front.emplace(longer_without(only(at_.triangles_at[e], alive_.triangles)), e);
    };
    offer(border_edge);
    std::size_t best = 0;
    double border = 0, shortest = 0;
    while (!front.empty()) {
      const auto [longer, e] = front.top();
      front.pop();
      if (!is_border(e)) continue;
      const Index t = only(at_.triangles_at[e], alive_.triangles);
      if (longer_without(t) != longer) {
        offer(e);  // its neighbours have changed
        continue;
      }
      if (border + longer > shortest + kAhead * gain_) break;
      if (!take(t, taken)) continue;
      border = taken.back().border = border + longer;
      if (border < shortest) {
        shortest = border;
        best = taken.size();
      }
      for (const Index side : at_.sides[t]) offer(side);
    }
    if (shortest > -gain_) best = 0;
    for (; taken.size() > best; taken.pop_back()) put_back(taken.back());
    return static_cast<Index>(best);
  }

  bool take(Index t, std::vector<Taken>& taken) {
    Taken now;
    now.triangle = t;
    if (!find_free(now)) return false;
    alive_.triangles[t] = 0;
    if (!hand_on(now)) {
      alive_.triangles[t] = 1;
      return false;
    }
    set_alive(now, 0);
    taken.push_back(std::move(now));
    return true;
  }
  void put_back(const Taken& taken) {
    take_back(taken);
    set_alive(taken, 1);
    for (const Index e : at_.sides[taken.triangle]) tried_[e] = 1;
  }
  void set_alive(const Taken& taken, std::uint8_t alive) {
    alive_.triangles[taken.triangle] = alive;
    for (const Index e : taken.edges) {
      if (e != kNone) alive_.edges[e] = alive;
    }
    if (taken.vertex != kNone) alive_.vertices[taken.vertex] = alive;
  }

  // One free side, or two and the corner between them, where nothing else is. False if there are none such.
  bool find_free(Taken& taken) const {
    std::size_t sides = 0;
    for (const Index e : at_.sides[taken.triangle]) {
      if (triangles_at(e) != 1) continue;
      if (sides == 2) return false;
      taken.edges[sides++] = e;
    }
    if (sides < 2) return sides == 1;
    const auto& [a, b] = complex_.edges[taken.edges[0]];
    const auto& other = complex_.edges[taken.edges[1]];
    taken.vertex = a == other[0] || a == other[1] ? a : b;
    const auto edges = at_.edges_at[taken.vertex];
    return std::count_if(edges.begin(), edges.end(), [&](Index e) { return alive_.edges[e] != 0; }) == 2;
  }

  // Hands each ball that a triangle holds, its own and those of triangles that went before, to one that stays: so what
  // went first is within `apart` of what is left at last, too. False, and nothing is done, if one of them has no
  // holder.
  bool hand_on(Taken& taken) {
    std::vector<Sphere> balls = own_balls(taken);
    const std::vector<Sphere>& held = held_[taken.triangle];
    balls.insert(balls.end(), held.begin(), held.end());
    for (const Sphere& ball : balls) {
      const Index holder = holder_of(ball);
      if (holder == kNone) {
        take_back(taken);
        return false;
      }
      held_[holder].push_back(ball);
      taken.holders.push_back(holder);
    }
    return true;
  }
  void take_back(const Taken& taken) {
    for (auto holder = taken.holders.rbegin(); holder != taken.holders.rend(); ++holder) held_[*holder].pop_back();
  }

  // The middle one, and those at the ends and thirds of free sides; all others at its sides are its neighbours' as
  // well.
  std::vector<Sphere> own_balls(const Taken& taken) const {
    const auto& [a, b, c] = complex_.triangles[taken.triangle];
    const ExactBall &of_a = complex_.balls[a], &of_b = complex_.balls[b], &of_c = complex_.balls[c];
    std::vector<Sphere> balls{
        {(of_a.center + of_b.center + of_c.center) / 3, (of_a.radius + of_b.radius + of_c.radius) / 3}};
    for (const Index e : taken.edges) {
      if (e == kNone) continue;
      const auto& [p, q] = complex_.edges[e];
      balls.push_back(ball(p, q, 1.0 / 3));
      balls.push_back(ball(p, q, 2.0 / 3));
    }
    if (taken.vertex != kNone) balls.push_back(ball(taken.vertex, taken.vertex, 0));
    return balls;
  }
  Sphere ball(Index a, Index b, double part) const {
    const ExactBall &p = complex_.balls[a], &q = complex_.balls[b];
    return {(1 - part) * p.center + part * q.center, (1 - part) * p.radius + part * q.radius};
  }

  // Another triangle that is there, in one of whose balls a ball lies, up to `apart`.
  Index holder_of(const Sphere& ball) const {
    Index holder = kNone;
    const double most = apart_ - ball.radius;
    tree_.min(
        ball.center, most,
        [&](Index t, const SupportTree::Item& balls, double least) {
          if (!alive_.triangles[t]) return least;
          const Sphere nearest = nearest_ball(ball.center, balls[0], balls[1], balls[2]);
          const double value = (nearest.center - ball.center).norm() - nearest.radius;
          if (value < least) holder = t;
          return value;
        },
        most);
    return holder;
  }

  BallComplex& complex_;
  const double apart_, gain_;
  const CellIncidence at_;
  const SupportTree tree_;  // of the triangles
  Alive alive_;
  std::vector<std::vector<Sphere>> held_;  // by each triangle, of those that went
  std::vector<std::uint8_t> tried_;        // edges of triangles that came back
};

}  // namespace

Index drop_doubled(BallComplex& complex, double apart, double gain) {
  return DoubledDropper(complex, apart, gain).run();
}

}  // namespace orchard::detail
