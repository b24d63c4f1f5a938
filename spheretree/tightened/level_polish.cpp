#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "level_trial.h"
#include "orchard/geometry/tolerance.h"

// LevelSolver's search among balls that cover the surface and never uncover it.
namespace orchard::detail {
namespace {

constexpr int kEvaluations = 10;
constexpr int kRounds = 8;            // of closing a trial
constexpr double kWorthwhile = 1e-4;  // part of a ball's looseness that must go

// What breaks ties between balls that would not get looser at all, as a fraction of growth.
constexpr double kTie = 1e-12;

std::vector<Point> ends(const std::vector<OpenArc>& arcs) {
  std::vector<Point> points;
  for (const OpenArc& arc : arcs) points.insert(points.end(), {arc.begin, arc.end});
  return points;
}

}  // namespace

void LevelSolver::take_radii(const LevelCover& cover) {
  for (Index b = 0; b < balls_.size(); ++b) {
    balls_[b].radius = cover.balls()[b].sphere.radius;
    find_members(balls_[b]);
  }
  recount();
}

void LevelSolver::refit(LevelCover& cover) {
  const double margin = tolerance::kCoverMargin * surface_.bounding_radius();
  std::vector<Index> order(balls_.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return balls_[a].looseness() > balls_[b].looseness(); });
  BallFitter fitter(surface_);
  LevelCover::Scratch scratch;
  std::vector<OpenArc> arcs;
  for (Index b : order) {
    const RegionBall old = cover.balls()[b];
    arcs.clear();
    cover.open_arcs(old.sphere, {{&b, 1}, {}}, scratch, arcs);
    if (arcs.empty()) continue;
    FittedBall fitted = fitter.fit(ends(arcs), balls_[b].center, kEvaluations);
    fitted.radius += margin;
    if (fitted.looseness() > balls_[b].looseness() * (1 - kWorthwhile)) continue;
    const RegionBall fresh{{fitted.center, fitted.radius}, old.region};
    if (!cover.covered(old.sphere, {{&b, 1}, {&fresh, 1}}, scratch)) continue;
    cover.replace(b, fresh);
    replace(b, fitted);
  }
}

void LevelSolver::polish(LevelCover& cover, Index trials) { run_trials(trials, &cover, {}); }

namespace {

Sphere around(std::span<const LevelBall> all, std::span<const Index> some) {
  Sphere sphere{Point::Zero(), 0};
  for (Index b : some) sphere.center += all[b].center / static_cast<double>(some.size());
  for (Index b : some) sphere.radius = std::max(sphere.radius, (all[b].center - sphere.center).norm() + all[b].radius);
  return sphere;
}

}  // namespace

// Makes a trial's balls cover what those that they replace covered.
class LevelSolver::TrialCloser {
 public:
  TrialCloser(const LevelSolver& solver, const LevelCover& cover, Trial& trial)
      : solver_(solver),
        cover_(cover),
        trial_(trial),
        margin_(tolerance::kCoverMargin * solver.surface_.bounding_radius()),
        fitter_(solver.surface_),
        added_(trial.balls.size()) {
    const std::span<const Index> chosen(trial.chosen);
    const std::size_t here = trial.moved == kNone ? chosen.size() : trial.moved;
    where_.push_back(around(solver.balls_, chosen.first(here)));
    if (here < chosen.size()) where_.push_back(around(solver.balls_, chosen.subspan(here)));
    for (std::size_t i = 0; i < added_.size(); ++i) put(i, trial.balls[i], 1);
  }

  double cost() const {
    double sum = 0;
    for (const LevelBall& ball : trial_.balls) sum += solver_.cost(ball);
    return sum;
  }

  // What is open goes to those that it costs least, until nothing is, or the cost is not below `most`.
  bool close(double max) {
    for (int round = 1; round <= kRounds; ++round) {
      arcs_.clear();
      for (const Sphere& sphere : where_) cover_.open_arcs(sphere, {trial_.chosen, added_}, scratch_, arcs_);
      if (arcs_.empty()) return true;
      std::vector<char> grown(added_.size(), 0);
      for (const OpenArc& arc : arcs_) {
        const std::size_t taker = cheapest_taker(arc);
        if (taker == kNone) return false;
        trial_.needs[taker].insert(trial_.needs[taker].end(), {arc.begin, arc.end});
        grown[taker] = 1;
      }
      for (std::size_t i = 0; i < added_.size(); ++i)
        if (grown[i]) put(i, fitter_.fit(trial_.needs[i], trial_.balls[i].center, kEvaluations), round);
      if (cost() >= max) return false;
    }
    return false;
  }

  // Each to what it alone holds.
  void refit() {
    for (std::size_t i = 0; i < added_.size(); ++i) {
      std::vector<RegionBall> others = added_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      arcs_.clear();
      cover_.open_arcs(added_[i].sphere, {trial_.chosen, others}, scratch_, arcs_);
      if (arcs_.empty()) continue;
      const FittedBall fitted = fitter_.fit(ends(arcs_), trial_.balls[i].center, kEvaluations);
      if (fitted.looseness() + margin_ <= trial_.balls[i].looseness() * (1 - kWorthwhile)) put(i, fitted, 1);
    }
  }

  bool covered() {
    return std::all_of(where_.begin(), where_.end(), [&](const Sphere& sphere) {
      return cover_.covered(sphere, {trial_.chosen, added_}, scratch_);
    });
  }

 private:
  void put(std::size_t i, FittedBall ball, int margins) {
    ball.radius += margins * margin_;
    static_cast<FittedBall&>(trial_.balls[i]) = ball;
    added_[i] = {{ball.center, ball.radius}, trial_.balls[i].region};
  }

  std::size_t cheapest_taker(const OpenArc& arc) const {
    double min = std::numeric_limits<double>::infinity();
    std::size_t taker = kNone;
    for (std::size_t i = 0; i < added_.size(); ++i) {
      const LevelBall& ball = trial_.balls[i];
      FittedBall larger = ball;
      larger.radius = std::max({ball.radius, (arc.begin - ball.center).norm(), (arc.end - ball.center).norm()});
      const double rise =
          solver_.cost(larger) - solver_.cost(ball) + kTie * larger.radius / solver_.surface_.bounding_radius();
      if (rise >= min || !cover_.in_region(ball.region, arc.begin) || !cover_.in_region(ball.region, arc.end)) continue;
      min = rise;
      taker = i;
    }
    return taker;
  }

  const LevelSolver& solver_;
  const LevelCover& cover_;
  Trial& trial_;
  const double margin_;
  BallFitter fitter_;
  std::vector<RegionBall> added_;
  std::vector<Sphere> where_;  // what may be open
  LevelCover::Scratch scratch_;
  std::vector<OpenArc> arcs_;
};

bool LevelSolver::close_trial(Trial& trial, double before, const LevelCover& cover) const {
  const double max = before * (1 - 1e-6);
  TrialCloser closer(*this, cover, trial);
  if (!closer.close(max)) return false;
  closer.refit();
  return closer.cost() < max && closer.covered();
}

}  // namespace orchard::detail
