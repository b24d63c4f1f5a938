#include "borders.h"

#include <utility>

#include "orchard/geometry/angle.h"

namespace orchard::detail {

double angle_at(const BallComplex& complex, Index at, Index a, Index b) {
  const Point& p = complex.balls[at].center;
  return angle_between(complex.balls[a].center - p, complex.balls[b].center - p);
}

Borders find_borders(const BallComplex& complex) {
  Borders borders;
  std::vector<std::uint8_t> count(complex.edges.size(), 0);
  borders.inner.assign(complex.size(), 0);
  const EdgeNumbers edge = complex.edge_numbers();
  for (const auto& [a, b, c] : complex.triangles) {
    for (const Index e : {edge(a, b), edge(a, c), edge(b, c)}) {
      if (count[e] < 3) ++count[e];
    }
  }
  borders.next.assign(complex.size(), {kNone, kNone});
  std::vector<std::uint8_t> branching(complex.size(), 0);
  for (Index e = 0; e < complex.edges.size(); ++e) {
    const auto& [a, b] = complex.edges[e];
    for (const auto& [v, other] : {std::pair{a, b}, std::pair{b, a}}) {
      if (count[e] == 1) {
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
  const auto add_angle = [&](Index at, Index a, Index b) {
    if (borders.next[at][0] != kNone) borders.inner[at] += angle_at(complex, at, a, b);
  };
  for (const auto& [a, b, c] : complex.triangles) {
    add_angle(a, b, c);
    add_angle(b, a, c);
    add_angle(c, a, b);
  }
  return borders;
}

}  // namespace orchard::detail
