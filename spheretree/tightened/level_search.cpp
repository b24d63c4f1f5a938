#include "level_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "trial_closing.h"

namespace orchard::detail {
namespace {

constexpr Index kBatch = 16;

Sphere sphere_of(const FittedBall& ball) { return {ball.center, ball.radius}; }

// A trial on a covering level was judged by the balls that meet its own balls, old and new.
bool meets_any(const LevelTrial& trial, const LevelBalls& balls, const std::vector<Sphere>& changed) {
  const auto meets = [&](const FittedBall& ball) {
    return std::any_of(changed.begin(), changed.end(), [&](const Sphere& other) {
      return (other.center - ball.center).norm() <= (other.radius + ball.radius) * (1 + 1e-9);
    });
  };
  return std::any_of(trial.balls.begin(), trial.balls.end(), meets) ||
         std::any_of(trial.chosen.begin(), trial.chosen.end(), [&](Index b) { return meets(balls[b]); });
}

}  // namespace

void LevelSearch::run(LevelBalls& balls, Index trials, const Progress& progress) {
  run(balls, trials, nullptr, progress);
}

void LevelSearch::run_covering(LevelBalls& balls, Index trials, LevelCover& cover) { run(balls, trials, &cover, {}); }

void LevelSearch::run(LevelBalls& balls, Index trials, LevelCover* cover, const Progress& progress) {
  if (balls.size() < 2) return;
  find_costs(balls);
  std::vector<LevelTrial> batch(kBatch);
  for (Index done = 0; done < trials; done += kBatch) {
    report_progress(progress, "searching", static_cast<double>(done) / trials);
    want();
    tbb::parallel_for(
        Index{0}, kBatch, [&](Index i) { batch[i] = propose(balls, trials_ + i, cover); }, tbb::simple_partitioner());
    trials_ += kBatch;
    apply(batch, balls, cover);
  }
}

void LevelSearch::find_costs(const LevelBalls& balls) {
  failures_.resize(balls.size(), 0);
  costs_.resize(balls.size());
  for (Index b = 0; b < balls.size(); ++b) costs_[b] = objective_.cost(balls[b]);
}

// Trials begin where the cost is largest, and less often where they have failed before.
void LevelSearch::want() {
  wanted_.resize(costs_.size());
  double sum = 0;
  for (std::size_t b = 0; b < costs_.size(); ++b) {
    sum += costs_[b] / (1.0 + failures_[b]);
    wanted_[b] = sum;
  }
}

LevelTrial LevelSearch::propose(const LevelBalls& balls, std::uint64_t number, const LevelCover* cover) {
  TrialScratch& scratch = scratches_.local();
  LevelTrial trial = propose_trial(balls, objective_, wanted_, Random(seed_, 200 + level_, number), scratch);
  if (trial.balls.empty()) return trial;
  if (cover != nullptr && !close_trial(surface_, balls, objective_, *cover, trial, scratch.fitter)) trial.balls.clear();
  for (LevelBall& ball : trial.balls) balls.find_samples(ball);
  return trial;
}

// A trial counts only if the balls by which it was judged are still there, so that no earlier trial of the batch
// changed them.
void LevelSearch::apply(std::vector<LevelTrial>& batch, LevelBalls& balls, LevelCover* cover) {
  std::vector<char> taken(balls.size(), 0);
  std::vector<Sphere> changed;
  for (LevelTrial& trial : batch) {
    ++failures_[trial.chosen[0]];
    const bool free = std::none_of(trial.chosen.begin(), trial.chosen.end(), [&](Index b) { return taken[b] != 0; });
    if (trial.balls.empty() || !free || (cover != nullptr && meets_any(trial, balls, changed))) continue;
    if (!balls.try_replace(trial.chosen, trial.balls)) continue;
    for (const LevelBall& old : trial.balls) changed.push_back(sphere_of(old));
    for (Index b : trial.chosen) {
      taken[b] = 1;
      failures_[b] = 0;
      costs_[b] = objective_.cost(balls[b]);
      changed.push_back(sphere_of(balls[b]));
      if (cover != nullptr) cover->replace(b, {changed.back(), balls[b].path_region});
    }
  }
}

}  // namespace orchard::detail
