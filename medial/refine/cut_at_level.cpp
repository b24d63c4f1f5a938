#include "cut_at_level.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace orchard::detail {
namespace {

// Maps a quotient to a number from 0 to 1, which is 1/2 for 1.
double scaled(double over_level) { return std::isfinite(over_level) ? over_level / (1 + over_level) : 1; }

double scaled_loss(const ExactBall& ball, double level) {
  return ball.radius > 0 && ball.count < 2 ? 0 : scaled(ball.loss / level);
}

using ValueOfBall = std::function<double(const ExactBall&)>;

class LevelCut {
 public:
  // `values` are those of the vertices, from 0 to 1. `value_of` gives that of a ball in between; without it, values are
  // interpolated.
  LevelCut(const Surface& surface, BallComplex& complex, std::vector<double> values, ValueOfBall value_of,
           double merging)
      : surface_(surface),
        complex_(complex),
        values_(std::move(values)),
        value_of_(std::move(value_of)),
        merging_(merging) {}

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
  bool crossing(BallSolver& solver, Index vertex_above, Index vertex_below, ExactBall& found) const {
    const ExactBall &above = complex_.balls[vertex_above], &below = complex_.balls[vertex_below];
    const double high = values_[vertex_above], low = values_[vertex_below];
    double from = 0, to = 1;
    bool any = false;
    for (int step = 0; step < kLevelSteps; ++step) {
      double t = step == 0 ? (high - 0.5) / (high - low) : 0.5 * (from + to);
      t = std::clamp(t, from + 0.05 * (to - from), to - 0.05 * (to - from));
      const ExactBall middle = solver.between(above, below, t);
      const double value = value_of_ ? value_of_(middle) : 0.5;
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
    const auto above = [&](Index v) { return values_[v] >= 0.5; };
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
        found[i] = crossing(solver, a, b, places[i]) ? 1 : 0;
      }
    });
    std::vector<Index> cut(complex_.edges.size(), kNone);
    for (std::size_t i = 0; i < crossed.size(); ++i) {
      if (!found[i]) continue;
      cut[crossed[i]] = complex_.size();
      complex_.balls.push_back(places[i]);
      values_.push_back(value_of_ ? value_of_(places[i]) : 0.5);
    }
    const Index cuts = static_cast<Index>(std::count_if(cut.begin(), cut.end(), [](Index v) { return v != kNone; }));
    subdivide(complex_, cut);
    return cuts;
  }

  void drop_below() {
    Doomed doomed(complex_);
    for (Index v = 0; v < complex_.size(); ++v) doomed.vertices[v] = values_[v] < 0.5 ? 1 : 0;
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      const auto& [a, b] = complex_.edges[e];
      doomed.edges[e] = doomed.vertices[a] != 0 || doomed.vertices[b] != 0 ? 1 : 0;
    }
    collapse(complex_, doomed, values_);
  }

  const Surface& surface_;
  BallComplex& complex_;
  std::vector<double> values_;
  const ValueOfBall value_of_;
  const double merging_;
};

}  // namespace

Index cut_at_level(const Surface& surface, BallComplex& complex, double level, double merging) {
  const ValueOfBall value_of = [level](const ExactBall& ball) { return scaled_loss(ball, level); };
  std::vector<double> values;
  values.reserve(complex.balls.size());
  for (const ExactBall& ball : complex.balls) values.push_back(value_of(ball));
  return LevelCut(surface, complex, std::move(values), value_of, merging).run();
}

Index cut_where_below(const Surface& surface, BallComplex& complex, const std::vector<double>& over_level,
                      double merging) {
  std::vector<double> values;
  values.reserve(over_level.size());
  for (const double value : over_level) values.push_back(scaled(value));
  return LevelCut(surface, complex, std::move(values), {}, merging).run();
}

}  // namespace orchard::detail
