#include <algorithm>
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
  NotchFiller(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options)
      : surface_(surface),
        complex_(complex),
        solver_(solver),
        options_(options),
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
  static constexpr double kMaxOuter = 150 * std::numbers::pi / 180;  // wider ones are no notch
  static constexpr double kMaxLength = 4;  // spacings: the third side of a triangle that fills a notch
  static constexpr double kNear = 0.3;     // of that side: how far the axis may be from its middle

  double outer_angle(Index v) const { return 2 * std::numbers::pi - borders_.inner[v]; }
  void offer(Index v) {
    if (borders_.next[v][0] != kNone && outer_angle(v) < kMaxOuter) queue_.emplace(outer_angle(v), v);
  }
  bool fits(Index v, Index a, Index b) {
    const ExactBall &p = complex_.balls[a], &q = complex_.balls[b];
    const double length = (p.center - q.center).norm();
    if (a == b || extension_.joined(a, b) || length > kMaxLength * options_.spacing || !p.exact || !q.exact)
      return false;
    // What sees each other over the notch, not back over the sheet.
    if (angle_at(complex_, v, a, b) > kMaxOuter + 0.2) return false;
    // Slack: what is a little off is divided later.
    const ExactBall& third = complex_.balls[v];
    const Point centroid = (p.center + q.center + third.center) / 3;
    const auto off = [&](const Point& center, double radius) {
      return ball_error(surface_, center, radius, length) > kBorderSlack * options_.tolerance;
    };
    if (off(centroid, (p.radius + q.radius + third.radius) / 3)) return false;
    if (off((p.center + q.center) / 2, (p.radius + q.radius) / 2)) return false;
    const ExactBall middle = solver_.between(p, q, 0.5);
    return middle.exact && middle.loss >= options_.level / 2 &&
           (middle.center - 0.5 * (p.center + q.center)).norm() <= kNear * length;
  }
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
  Borders borders_;
  FreeExtension extension_;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue_;
};

}  // namespace

Index fill_notches(const Surface& surface, BallComplex& complex, BallSolver& solver, const BorderOptions& options) {
  return NotchFiller(surface, complex, solver, options).run();
}

}  // namespace orchard::detail
