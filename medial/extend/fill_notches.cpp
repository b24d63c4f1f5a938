#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <utility>

#include "borders.h"
#include "extend_sheets.h"
#include "free_extension.h"

namespace orchard::detail {
namespace {

class NotchFiller {
 public:
  NotchFiller(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options,
              const SplitOptions& dividing, const NotchLimits& limits)
      : surface_(surface),
        complex_(complex),
        solver_(solver),
        options_(options),
        dividing_(dividing),
        limits_(limits),
        borders_(find_borders(complex)),
        extension_(complex) {}

  Index run() {
    for (Index v = 0; v < complex_.size(); ++v) offer(v);
    while (!queue_.empty()) {
      const auto [outer, v] = queue_.top();
      queue_.pop();
      if (borders_.next[v][0] != kNone && outer == outer_angle(v)) fill(v);
    }
    return extension_.finish();
  }

 private:
  static constexpr double kNear = 0.3;  // of the third side: the largest distance of the axis from its middle

  double outer_angle(Index v) const { return 2 * std::numbers::pi - borders_.inner[v]; }
  void offer(Index v) {
    if (borders_.next[v][0] != kNone && outer_angle(v) < limits_.max_angle) queue_.emplace(outer_angle(v), v);
  }
  bool fits(Index v, Index a, Index b) {
    const ExactBall &p = complex_.balls[a], &q = complex_.balls[b], &third = complex_.balls[v];
    const double length = (p.center - q.center).norm();
    if (a == b || extension_.joined(a, b) || length > limits_.max_length * options_.spacing) return false;
    // The two edges have to face each other across the notch, not across the sheet or behind a triangle that is folded
    // over.
    const double seen = angle_at(complex_, v, a, b);
    if (seen > limits_.max_angle || std::abs(seen - outer_angle(v)) > limits_.max_bend) return false;
    const ExactBall middle = solver_.between(p, q, 0.5);
    if (middle.loss < limits_.min_loss * options_.level) return false;
    if ((middle.center - 0.5 * (p.center + q.center)).norm() > kNear * length) return false;
    const bool exact = p.exact && q.exact && middle.exact;
    if (exact && !is_nearly_linear(p, q, third)) return false;
    return limits_.on_trial ? becomes_right(p, q, third, exact) : exact;
  }
  bool becomes_right(const ExactBall& p, const ExactBall& q, const ExactBall& third, bool divided) const {
    SplitOptions dividing = dividing_;
    if (!divided) dividing.max_rounds = 0;
    return may_end(p) && may_end(q) && becomes_linear(surface_, p, q, third, dividing);
  }
  // The slack allows cells that are slightly off, because they are divided later at balls between exact ones.
  bool is_nearly_linear(const ExactBall& p, const ExactBall& q, const ExactBall& third) const {
    const double length = (p.center - q.center).norm();
    const auto off = [&](const Point& center, double radius) {
      return ball_error(surface_, center, radius, length) > kBorderSlack * options_.tolerance;
    };
    return !off((p.center + q.center + third.center) / 3, (p.radius + q.radius + third.radius) / 3) &&
           !off((p.center + q.center) / 2, (p.radius + q.radius) / 2);
  }
  // A vertex of radius 0 on a face of the surface is no valid end.
  static bool may_end(const ExactBall& ball) { return ball.exact || ball.radius > 0; }
  void fill(Index v) {
    const auto [a, b] = borders_.next[v];
    if (!fits(v, a, b) || !extension_.add(v, a, b)) return;
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
  const SplitOptions& dividing_;
  const NotchLimits& limits_;
  Borders borders_;
  FreeExtension extension_;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue_;
};

}  // namespace

Index fill_notches(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options,
                   const SplitOptions& dividing, const NotchLimits& limits) {
  return NotchFiller(surface, complex, solver, options, dividing, limits).run();
}

}  // namespace orchard::detail
