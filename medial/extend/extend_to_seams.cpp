#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "extend_sheets.h"
#include "orchard/geometry/angle.h"
#include "sheet_extension.h"

namespace orchard::detail {
namespace {

class SeamReacher {
 public:
  SeamReacher(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : sheets_(surface, complex, options) {}

  Index run() {
    find_outward();
    find_seams();
    for (const Index e : sheets_.borders) {
      const auto& [a, b] = sheets_.complex.edges[e];
      const Index x = seam_[a], y = seam_[b];
      if (x != kNone && y != kNone) sheets_.triangles.add_strip(a, b, x, y);
      if (x != kNone && y == kNone && sheets_.complex.balls[b].count > 2) sheets_.triangles.add(a, b, x);
      if (x == kNone && y != kNone && sheets_.complex.balls[a].count > 2) sheets_.triangles.add(a, b, y);
    }
    return sheets_.triangles.finish();
  }

 private:
  // Contacts that are seen at this angle or more count as parallel faces.
  static constexpr double kParallel = 150 * std::numbers::pi / 180;
  static constexpr double kStep = 0.25;  // spacings
  static constexpr double kReach = 2;    // spacings
  static constexpr int kMaxSteps = 64;

  // At each border vertex, sums up the directions from its border edges away from their triangles, in the planes of
  // these.
  void find_outward() {
    outward_.assign(sheets_.complex.size(), Vector::Zero());
    for (const Index e : sheets_.borders) {
      const auto& [a, b] = sheets_.complex.edges[e];
      const Point &p = sheets_.complex.balls[a].center, &q = sheets_.complex.balls[b].center;
      for (const Index v : sheets_.complex.triangles[sheets_.at.triangles_at[e][0]]) {
        if (v == a || v == b) continue;
        const Vector along = q - p, from = p - sheets_.complex.balls[v].center;
        const Vector out = from - along * (from.dot(along) / along.squaredNorm());
        if (!(out.norm() > 0)) continue;
        outward_[a] += out.normalized();
        outward_[b] += out.normalized();
      }
    }
  }

  void find_seams() {
    const Index before = sheets_.complex.size();
    std::vector<ExactBall> found(before);
    tbb::parallel_for(tbb::blocked_range<Index>(0, before, 64), [&](const auto& range) {
      BallSolver solver(sheets_.surface, sheets_.options.merging);
      for (Index v = range.begin(); v != range.end(); ++v) {
        if (outward_[v] != Vector::Zero() && is_between_parallel_faces(sheets_.complex.balls[v]))
          found[v] = seam_beyond(sheets_.complex.balls[v], outward_[v].normalized(), solver);
      }
    });
    seam_.assign(before, kNone);
    for (Index v = 0; v < before; ++v) {
      if (found[v].exact) seam_[v] = sheets_.triangles.add_vertex(found[v]);
    }
  }
  static bool is_between_parallel_faces(const ExactBall& ball) {
    return ball.exact && ball.count == 2 && ball.radius > 0 &&
           angle_between(ball.contacts[0].position - ball.center, ball.contacts[1].position - ball.center) > kParallel;
  }
  // Returns the first ball on the way out that has a third contact, or a ball that is not exact if there is none.
  ExactBall seam_beyond(const ExactBall& from, const Vector& out, BallSolver& solver) const {
    // No step may leave the solid: beyond a seam, the solid may end within half the thickness.
    const double step = std::min(kStep * sheets_.options.spacing, from.radius / 2);
    const int steps = std::min(kMaxSteps, static_cast<int>(std::ceil(kReach * sheets_.options.spacing / step)));
    ExactBall at = from;
    for (int i = 0; i < steps; ++i) {
      const Point start = at.center + step * out;
      ExactBall next = solver.solve(start, at.touching());
      const bool goes_on = next.exact && (next.center - start).norm() <= step && next.loss >= sheets_.options.level;
      if (!goes_on) break;
      if (next.count > 2) return next;
      at = next;
    }
    return {};
  }

  SheetExtension sheets_;
  std::vector<Index> seam_;  // the seam vertex of each border vertex
  std::vector<Vector> outward_;
};

}  // namespace

Index extend_to_seams(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return SeamReacher(surface, complex, options).run();
}

}  // namespace orchard::detail
