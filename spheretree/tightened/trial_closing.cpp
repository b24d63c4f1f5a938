#include "trial_closing.h"

#include <algorithm>
#include <limits>

#include "level_tightening.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr int kClosingEvaluations = 10;
constexpr int kTrialClosingRounds = 8;
// As a fraction of the radius: a small cost that decides between balls that would not get looser at all.
constexpr double kTie = 1e-12;

Sphere around(const LevelBalls& all, std::span<const Index> some) {
  Sphere sphere{Point::Zero(), 0};
  for (Index b : some) sphere.center += all[b].center / static_cast<double>(some.size());
  for (Index b : some) sphere.radius = std::max(sphere.radius, (all[b].center - sphere.center).norm() + all[b].radius);
  return sphere;
}

class TrialCloser {
 public:
  TrialCloser(const Surface& surface, const LevelBalls& balls, const LevelObjective& objective, const LevelCover& cover,
              LevelTrial& trial, BallFitter& fitter)
      : objective_(objective),
        cover_(cover),
        trial_(trial),
        radius_(surface.bounding_radius()),
        margin_(tolerance::kCoverMargin * radius_),
        fitter_(fitter),
        added_(trial.balls.size()) {
    const std::span<const Index> chosen(trial.chosen);
    const std::size_t here = trial.moved == kNone ? chosen.size() : trial.moved;
    where_.push_back(around(balls, chosen.first(here)));
    if (here < chosen.size()) where_.push_back(around(balls, chosen.subspan(here)));
    for (std::size_t i = 0; i < added_.size(); ++i) put(i, trial.balls[i], 1);
    cover_.triangles_resting_on(chosen, scratch_, resting_);
  }

  bool worthwhile() const { return objective_.cost(trial_.balls) < trial_.max_cost; }

  // Returns false if something is still open after some rounds, or if the trial is no longer worthwhile.
  bool close() {
    for (int round = 1; round <= kTrialClosingRounds; ++round) {
      arcs_.clear();
      for (const Sphere& sphere : where_) cover_.open_arcs(resting_, sphere, {trial_.chosen, added_}, scratch_, arcs_);
      if (arcs_.empty()) return true;
      std::vector<char> grown(added_.size(), 0);
      for (const OpenArc& arc : arcs_) {
        const std::size_t candidate = cheapest_candidate(arc);
        if (candidate == kNone) return false;
        trial_.needs[candidate].insert(trial_.needs[candidate].end(), {arc.begin, arc.end});
        grown[candidate] = 1;
      }
      for (std::size_t i = 0; i < added_.size(); ++i)
        if (grown[i]) put(i, fitter_.fit(trial_.needs[i], trial_.balls[i], kClosingEvaluations), round);
      if (!worthwhile()) return false;
    }
    return false;
  }

  // Fits each ball to what only it contains.
  void refit() {
    for (std::size_t i = 0; i < added_.size(); ++i) {
      std::vector<PlacedBall> others = added_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      arcs_.clear();
      cover_.open_arcs(resting_, added_[i].sphere, {trial_.chosen, others}, scratch_, arcs_);
      if (arcs_.empty()) continue;
      const FittedBall fitted = fitter_.fit(ends_of(arcs_), trial_.balls[i], kClosingEvaluations);
      if (fitted.looseness() + margin_ <= trial_.balls[i].looseness() * (1 - kWorthwhileTightening)) put(i, fitted, 1);
    }
  }

  bool covered() {
    return std::all_of(where_.begin(), where_.end(), [&](const Sphere& sphere) {
      return cover_.covered(resting_, sphere, {trial_.chosen, added_}, scratch_);
    });
  }

 private:
  void put(std::size_t i, FittedBall ball, int margins) {
    ball.radius += margins * margin_;
    static_cast<FittedBall&>(trial_.balls[i]) = ball;
    added_[i] = {{ball.center, ball.radius}, trial_.balls[i].path_region};
  }

  // Returns the cheapest of the trial's balls whose path region contains both ends.
  std::size_t cheapest_candidate(const OpenArc& arc) const {
    double min = std::numeric_limits<double>::infinity();
    std::size_t candidate = kNone;
    for (std::size_t i = 0; i < added_.size(); ++i) {
      const LevelBall& ball = trial_.balls[i];
      FittedBall larger = ball;
      larger.radius = std::max({ball.radius, (arc.begin - ball.center).norm(), (arc.end - ball.center).norm()});
      const double rise = objective_.cost(larger) - objective_.cost(ball) + kTie * larger.radius / radius_;
      if (rise >= min || !cover_.in_path_region(ball.path_region, arc.begin) ||
          !cover_.in_path_region(ball.path_region, arc.end))
        continue;
      min = rise;
      candidate = i;
    }
    return candidate;
  }

  const LevelObjective& objective_;
  const LevelCover& cover_;
  LevelTrial& trial_;
  const double radius_, margin_;
  BallFitter& fitter_;
  std::vector<PlacedBall> added_;  // the trial's balls in the form of the cover
  std::vector<Sphere> where_;      // places that may be open
  std::vector<Index> resting_;     // triangles that may be open
  LevelCover::Scratch scratch_;
  std::vector<OpenArc> arcs_;
};

}  // namespace

bool close_trial(const Surface& surface, const LevelBalls& balls, const LevelObjective& objective,
                 const LevelCover& cover, LevelTrial& trial, BallFitter& fitter) {
  TrialCloser closer(surface, balls, objective, cover, trial, fitter);
  if (!closer.close()) return false;
  closer.refit();
  return closer.worthwhile() && closer.covered();
}

}  // namespace orchard::detail
