#include "spread_flat.h"

#include <algorithm>
#include <array>

#include "flat_triangle.h"

namespace orchard::detail {
namespace {

constexpr double kShift = 3e-4;  // of that edge: how far a vertex goes
constexpr double kOff = 0.5;     // of the shift: no ball farther than this from where it is looked for

double length(const BallComplex& complex, Index a, Index b) {
  return (complex.balls[a].center - complex.balls[b].center).norm();
}

// The corners, those of the longest edge first.
std::array<Index, 3> longest_first(const BallComplex& complex, const std::array<Index, 3>& corners) {
  auto [a, b, c] = corners;
  const double ab = length(complex, a, b), bc = length(complex, b, c), ca = length(complex, c, a);
  if (bc > ab && bc >= ca) return {b, c, a};
  if (ca > ab) return {c, a, b};
  return {a, b, c};
}

bool has_no_plane(const BallComplex& complex, const std::array<Index, 3>& corners) {
  const auto center = [&](std::size_t i) { return complex.balls[corners[i]].center; };
  return is_flat_triangle(center(0), center(1), center(2));
}

class FlatSpreader {
 public:
  FlatSpreader(const Surface& surface, BallComplex& complex, double merging)
      : complex_(complex), at_(complex.edges, complex.triangles, complex.size()), solver_(surface, merging) {}

  Index run() {
    Index moved = 0;
    for (const std::array<Index, 3>& corners : complex_.triangles) {
      if (!has_no_plane(complex_, corners)) continue;
      const auto [a, b, c] = longest_first(complex_, corners);
      if (move(c, complex_.balls[b].center - complex_.balls[a].center)) ++moved;
    }
    return moved;
  }

 private:
  // Along the sheet between any two contacts, to either side.
  bool move(Index v, const Vector& along) {
    const ExactBall ball = complex_.balls[v];
    if (!ball.exact || !(ball.radius > 0)) return false;
    const std::size_t flat = flat_at(v);
    for (std::size_t i = 0; i < ball.touching().size(); ++i) {
      for (std::size_t k = i + 1; k < ball.touching().size(); ++k) {
        const std::array<ClosestPoint, 2> held{ball.contacts[i], ball.contacts[k]};
        const Vector across = (held[0].position - held[1].position).cross(along);
        if (!(across.norm() > 0)) continue;
        const Vector shift = kShift * along.norm() * across.normalized();
        if (try_at(v, shift, held, flat) || try_at(v, -shift, held, flat)) return true;
      }
    }
    return false;
  }

  bool try_at(Index v, const Vector& shift, const std::array<ClosestPoint, 2>& held, std::size_t flat) {
    const ExactBall before = complex_.balls[v];
    const Point place = before.center + shift;
    const ExactBall moved = solver_.solve(place, held);
    if (!moved.exact || !((moved.center - place).norm() <= kOff * shift.norm())) return false;
    complex_.balls[v] = moved;
    if (flat_at(v) < flat) return true;
    complex_.balls[v] = before;
    return false;
  }

  // How many triangles at a vertex are flat; those on two edges of it count twice.
  std::size_t flat_at(Index v) const {
    std::size_t count = 0;
    for (const Index e : at_.edges_at[v]) {
      for (const Index t : at_.triangles_at[e]) count += has_no_plane(complex_, complex_.triangles[t]) ? 1 : 0;
    }
    return count;
  }

  BallComplex& complex_;
  const CellIncidence at_;
  BallSolver solver_;
};

}  // namespace

Index spread_flat(const Surface& surface, BallComplex& complex, double merging) {
  return FlatSpreader(surface, complex, merging).run();
}

}  // namespace orchard::detail
