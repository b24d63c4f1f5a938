#include "cut_at_level.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace orchard::detail {
namespace {

// Maps a loss to a number from 0 to 1, which is 1/2 at the level.
double scaled(const ExactBall& ball, double level) {
  if (ball.radius > 0 && ball.count < 2) return 0;
  if (!std::isfinite(ball.loss)) return 1;
  const double ratio = ball.loss / level;
  return ratio / (1 + ratio);
}

class LevelCut {
 public:
  LevelCut(const Surface& surface, BallComplex& complex, double level, double merging)
      : surface_(surface), complex_(complex), level_(level), merging_(merging) {}

  Index run() {
    const Index cuts = cut_edges();
    drop_below();
    return cuts;
  }

 private:
  static constexpr int kLevelSteps = 5;       // steps of bisection towards the place where an edge crosses the level
  static constexpr double kNearLevel = 0.04;  // of the loss: bisection ends when it is this near to the level

  // Finds where an edge from a vertex above the level to one below crosses it. Returns the last exact ball above the
  // level, and false if there is none.
  bool crossing(BallSolver& solver, const ExactBall& above, const ExactBall& below, ExactBall& found) const {
    const double high = scaled(above, level_), low = scaled(below, level_);
    double from = 0, to = 1;
    bool any = false;
    for (int step = 0; step < kLevelSteps; ++step) {
      double t = step == 0 ? (high - 0.5) / (high - low) : 0.5 * (from + to);
      t = std::clamp(t, from + 0.05 * (to - from), to - 0.05 * (to - from));
      const ExactBall middle = solver.between(above, below, t);
      const double value = scaled(middle, level_);
      if (!middle.exact || value < 0.5) {
        to = t;
        continue;
      }
      from = t;
      found = middle;
      any = true;
      if (value < 0.5 + kNearLevel / 2) break;
    }
    return any;
  }

  Index cut_edges() {
    const auto above = [&](Index v) { return scaled(complex_.balls[v], level_) >= 0.5; };
    std::vector<Index> crossed;
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      if (above(complex_.edges[e][0]) != above(complex_.edges[e][1])) crossed.push_back(e);
    }
    std::vector<ExactBall> places(crossed.size());
    std::vector<std::uint8_t> found(crossed.size(), 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, crossed.size(), 32), [&](const auto& range) {
      BallSolver solver(surface_, merging_);
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        auto [a, b] = complex_.edges[crossed[i]];
        if (!above(a)) std::swap(a, b);
        found[i] = crossing(solver, complex_.balls[a], complex_.balls[b], places[i]) ? 1 : 0;
      }
    });
    std::vector<Index> cut(complex_.edges.size(), kNone);
    for (std::size_t i = 0; i < crossed.size(); ++i) {
      if (!found[i]) continue;
      cut[crossed[i]] = complex_.size();
      complex_.balls.push_back(places[i]);
    }
    const Index cuts = static_cast<Index>(std::count_if(cut.begin(), cut.end(), [](Index v) { return v != kNone; }));
    subdivide(complex_, cut);
    return cuts;
  }

  void drop_below() {
    std::vector<double> value(complex_.size());
    Doomed doomed(complex_);
    for (Index v = 0; v < complex_.size(); ++v) {
      value[v] = scaled(complex_.balls[v], level_);
      doomed.vertices[v] = value[v] < 0.5 ? 1 : 0;
    }
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      const auto& [a, b] = complex_.edges[e];
      doomed.edges[e] = doomed.vertices[a] != 0 || doomed.vertices[b] != 0 ? 1 : 0;
    }
    collapse(complex_, doomed, value);
  }

  const Surface& surface_;
  BallComplex& complex_;
  const double level_, merging_;
};

}  // namespace

Index cut_at_level(const Surface& surface, BallComplex& complex, double level, double merging) {
  return LevelCut(surface, complex, level, merging).run();
}

}  // namespace orchard::detail
