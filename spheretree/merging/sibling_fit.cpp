#include "sibling_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "infinity.h"

namespace orchard::detail {
namespace {

constexpr int kSiblingEvaluations = 10;
constexpr int kDividingRounds = 6;  // rounds of dividing and fitting at the beginning
constexpr int kExchangeRounds = 5;
constexpr int kMaxExchanges = 24;  // the number of exchanges for eight siblings; more siblings get more
constexpr int kVictims = 7;        // the number of balls, the cheapest first, that an exchange tries to remove

class Fit {
 public:
  Fit(const Surface& surface, const std::vector<Point>& points, double power, bool patient)
      : points_(points), surface_(surface), power_(power), patient_(patient), fitter_(surface) {}

  Siblings run(std::span<const std::vector<FittedBall>> starts, std::size_t wanted) {
    wanted = std::min(wanted, points_.size());
    Siblings best;
    double min = kInfinity;
    for (const std::vector<FittedBall>& start : starts) {
      begin(start, wanted);
      if (best_ < min || best.balls.empty()) min = best_, best = best_state_;
    }
    best_state_ = std::move(best);
    best_ = min;
    fill_up(wanted);
    exchange();
    fill_up(wanted);  // an exchange may have lost a ball
    return std::move(best_state_);
  }

 private:
  void begin(const std::vector<FittedBall>& start, std::size_t wanted) {
    best_state_ = {};
    best_ = kInfinity;
    Siblings state{start, std::vector<Index>(points_.size(), 0)};
    improve(state, kDividingRounds, true);
    while (best_state_.balls.size() > wanted) lose_cheapest();
  }

  double objective(const Siblings& state) const {
    double sum = 0;
    for (const FittedBall& ball : state.balls) sum += cost(ball);
    return sum;
  }
  double cost(const FittedBall& ball) const { return std::pow(std::max(0.0, ball.looseness()), power_); }

  void divide(Siblings& state) const {
    for (Index p = 0; p < points_.size(); ++p) {
      double min = kInfinity;
      for (Index b = 0; b < state.balls.size(); ++b) {
        const double k = state.balls[b].looseness_with(points_[p]);
        if (k < min) min = k, state.owner[p] = b;
      }
    }
  }

  // Fits the balls that are marked, and drops those without points.
  void fit(Siblings& state, const std::vector<char>& marked) {
    own_.resize(std::max(own_.size(), state.balls.size()));
    for (auto& list : own_) list.clear();
    for (Index p = 0; p < points_.size(); ++p) own_[state.owner[p]].push_back(points_[p]);
    std::vector<Index> place(state.balls.size(), kNone);
    Index count = 0;
    for (Index b = 0; b < state.balls.size(); ++b) {
      if (own_[b].empty()) continue;
      FittedBall ball = state.balls[b];
      if (marked[b]) ball = fitter_.fit(own_[b], ball, kSiblingEvaluations);
      place[b] = count;
      state.balls[count++] = ball;
    }
    state.balls.resize(count);
    for (Index& owner : state.owner) owner = place[owner];
  }

  // Fits in rounds. If the result is better than the best so far, it becomes the best. Returns whether it did.
  bool improve(Siblings& state, int rounds, bool all) {
    bool better = false;
    double last = kInfinity;
    for (int round = 0; round < rounds; ++round) {
      const std::vector<Index> before = state.owner;
      divide(state);
      if (round > 0 && state.owner == before) break;
      std::vector<char> marked(state.balls.size(), all && round == 0);
      for (Index p = 0; p < points_.size(); ++p)
        if (state.owner[p] != before[p]) marked[state.owner[p]] = marked[before[p]] = 1;
      fit(state, marked);
      const double now = objective(state);
      // Gains get smaller from round to round. If the cost falls too slowly to get below the best, the rest is skipped.
      if (!patient_ && now - best_ > (last - now) * (rounds - 1 - round)) break;
      last = now;
      if (now >= best_ && best_state_.balls.size() >= state.balls.size()) continue;
      best_ = now;
      best_state_ = state;
      better = true;
    }
    return better;
  }

  // Adds a new ball at the point of the loosest ball that is farthest from its centre.
  void split(Siblings& state, Index loosest) const {
    Index far = kNone;
    double max = -1;
    for (Index p = 0; p < points_.size(); ++p) {
      const double squared = (points_[p] - state.balls[loosest].center).squaredNorm();
      if (state.owner[p] == loosest && squared > max) max = squared, far = p;
    }
    const Point start = points_[far] + 0.3 * (state.balls[loosest].center - points_[far]);
    state.balls.push_back({start, 0, surface_.signed_distance(start)});
  }

  static Index loosest_of(const std::vector<FittedBall>& balls) {
    return static_cast<Index>(
        std::max_element(balls.begin(), balls.end(),
                         [](const FittedBall& a, const FittedBall& b) { return a.looseness() < b.looseness(); }) -
        balls.begin());
  }

  void fill_up(std::size_t wanted) {
    while (best_state_.balls.size() < wanted && split_loosest()) {
    }
  }

  bool split_loosest() {
    Siblings state = best_state_;
    split(state, loosest_of(state.balls));
    const std::size_t before = best_state_.balls.size();
    improve(state, kExchangeRounds, false);
    return best_state_.balls.size() > before;
  }

  // Returns the balls, sorted by the additional cost of the others if they take over the points of the ball.
  std::vector<Index> cheapest_to_lose(const Siblings& state) const {
    const auto count = static_cast<Index>(state.balls.size());
    std::vector<std::vector<double>> reach(count, std::vector<double>(count, 0));  // [lost][candidate]
    for (Index p = 0; p < points_.size(); ++p) {
      const Index lost = state.owner[p];
      Index candidate = kNone;
      double min = kInfinity;
      for (Index b = 0; b < count; ++b) {
        if (b == lost) continue;
        const double k = state.balls[b].looseness_with(points_[p]);
        if (k < min) min = k, candidate = b;
      }
      reach[lost][candidate] = std::max(reach[lost][candidate], min);
    }
    std::vector<double> rise(count, 0);
    for (Index lost = 0; lost < count; ++lost) {
      rise[lost] = -cost(state.balls[lost]);
      for (Index b = 0; b < count; ++b) {
        const double loose = std::max(0.0, state.balls[b].looseness());
        if (reach[lost][b] > loose) rise[lost] += std::pow(reach[lost][b], power_) - std::pow(loose, power_);
      }
    }
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return rise[a] < rise[b]; });
    return order;
  }

  void lose_cheapest() {
    Siblings state = std::move(best_state_);
    state.balls[cheapest_to_lose(state)[0]].center_distance = kInfinity;  // so that it gets no points
    best_state_ = {};
    best_ = kInfinity;
    improve(state, kExchangeRounds, false);
  }

  void exchange() {
    const int max = kMaxExchanges * static_cast<int>(1 + best_state_.balls.size() / 16);
    for (int done = 0; done < max && best_state_.balls.size() > 2 && exchange_once(); ++done) {
    }
  }

  bool exchange_once() {
    const std::vector<Index> order = cheapest_to_lose(best_state_);
    const Index loosest = loosest_of(best_state_.balls);
    int tried = 0;
    for (Index lost : order) {
      if (lost == loosest) continue;
      if (++tried > kVictims) break;
      Siblings state = best_state_;
      split(state, loosest);
      state.balls[lost].center_distance = kInfinity;
      if (improve(state, kExchangeRounds, false)) return true;
    }
    return false;
  }

  const std::vector<Point>& points_;
  const Surface& surface_;
  const double power_;
  const bool patient_;
  BallFitter fitter_;
  std::vector<std::vector<Point>> own_;
  Siblings best_state_;
  double best_ = kInfinity;
};

}  // namespace

Siblings fit_siblings(const Surface& surface, const std::vector<Point>& points,
                      std::span<const std::vector<FittedBall>> starts, std::size_t wanted, double power, bool patient) {
  return Fit(surface, points, power, patient).run(starts, wanted);
}

}  // namespace orchard::detail
