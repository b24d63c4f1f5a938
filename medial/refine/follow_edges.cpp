#include <algorithm>
#include <vector>

#include "extend_sheets.h"
#include "sharp_ends.h"

namespace orchard::detail {
namespace {

constexpr int kMaxRounds = 4;    // of halving border edges
constexpr double kApart = 0.05;  // of a border edge: how far from its ends it may be cut

// Border edges between places of the surface.
std::vector<Index> borders_on_surface(const BallComplex& complex) {
  const auto on_surface = [&](Index v) { return !(complex.balls[v].radius > 0); };
  std::vector<std::uint8_t> triangles(complex.edges.size(), 0);
  const EdgeNumbers edge = complex.edge_numbers();
  const auto count = [&](Index a, Index b) {
    if (!on_surface(a) || !on_surface(b)) return;
    std::uint8_t& at = triangles[edge(a, b)];
    if (at < 2) ++at;
  };
  for (const auto& [a, b, c] : complex.triangles) {
    count(a, b);
    count(a, c);
    count(b, c);
  }
  std::vector<Index> borders;
  for (Index e = 0; e < triangles.size(); ++e) {
    if (triangles[e] == 1) borders.push_back(e);
  }
  return borders;
}

}  // namespace

Index follow_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  SharpEdges edges(surface, options.sharp_angle);
  const Index before = complex.size();
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<Index> cut(complex.edges.size(), kNone);
    const Index first = complex.size();
    for (const Index e : borders_on_surface(complex)) {
      const ExactBall &a = complex.balls[complex.edges[e][0]], &b = complex.balls[complex.edges[e][1]];
      const Point middle = 0.5 * (a.center + b.center);
      const double length = (a.center - b.center).norm();
      ClosestPoint foot = ExactBall::nowhere();
      if (!edges.nearest(middle, length, foot) || (foot.position - middle).norm() <= options.tolerance / 2) continue;
      const auto divides = [&](const Point& place) {
        return std::min((place - a.center).norm(), (place - b.center).norm()) > kApart * length;
      };
      ClosestPoint corner = ExactBall::nowhere();
      if (edges.nearest_end(middle, length, corner) && divides(corner.position)) foot = corner;
      if (!divides(foot.position)) continue;
      cut[e] = complex.size();
      complex.balls.push_back(ball_on_edge(foot));
    }
    if (complex.size() == first) break;
    subdivide(complex, cut);
  }
  return complex.size() - before;
}

}  // namespace orchard::detail
