#include "solve_again.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace orchard::detail {
namespace {

constexpr double kOutlier = 0.5;          // of the smallest neighbour's radius
constexpr std::size_t kMaxContacts = 24;  // contacts of neighbours that are tried

// What is around a vertex inside a sheet.
struct Ring {
  Point middle = Point::Zero();  // of the exact neighbours
  double reach = 0;              // how far these are from it
  double min_radius = std::numeric_limits<double>::infinity();
  std::vector<ClosestPoint> contacts;
  bool closed = true;  // every edge at the vertex has two triangles
};

Ring ring_of(const BallComplex& complex, const CellIncidence& at, Index v) {
  Ring ring;
  Index count = 0;
  const auto neighbor = [&](Index e) -> const ExactBall& {
    const auto& [a, b] = complex.edges[e];
    return complex.balls[a == v ? b : a];
  };
  for (const Index e : at.edges_at[v]) {
    const ExactBall& ball = neighbor(e);
    ring.closed = ring.closed && at.triangles_at[e].size() == 2;
    ring.min_radius = std::min(ring.min_radius, ball.radius);
    if (!ball.exact) continue;
    ring.middle += ball.center;
    ++count;
    for (const ClosestPoint& contact : ball.touching()) {
      if (ring.contacts.size() < kMaxContacts) ring.contacts.push_back(contact);
    }
  }
  ring.closed = ring.closed && count > 2;
  if (!ring.closed) return ring;
  ring.middle /= count;
  for (const Index e : at.edges_at[v]) {
    const ExactBall& ball = neighbor(e);
    if (ball.exact) ring.reach = std::max(ring.reach, (ball.center - ring.middle).norm());
  }
  return ring;
}

}  // namespace

Index solve_outliers_again(const Surface& surface, BallComplex& complex, double merging) {
  const CellIncidence at(complex.edges, complex.triangles, complex.size());
  std::vector<ExactBall> solved(complex.size());
  tbb::parallel_for(tbb::blocked_range<Index>(0, complex.size(), 256), [&](const auto& range) {
    BallSolver solver(surface, merging);
    for (Index v = range.begin(); v != range.end(); ++v) {
      const Ring ring = ring_of(complex, at, v);
      const ExactBall& ball = complex.balls[v];
      if (!ring.closed || (ball.exact && ball.radius >= kOutlier * ring.min_radius)) continue;
      const ExactBall again = solver.solve(ring.middle, ring.contacts);
      if (again.exact && (again.center - ring.middle).norm() <= ring.reach &&
          again.radius >= kOutlier * ring.min_radius)
        solved[v] = again;
    }
  });
  Index count = 0;
  for (Index v = 0; v < complex.size(); ++v) {
    if (!solved[v].exact) continue;
    complex.balls[v] = solved[v];
    ++count;
  }
  return count;
}

}  // namespace orchard::detail
