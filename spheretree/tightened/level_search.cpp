#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "level_trial.h"

// The large-neighbourhood search of LevelSolver. The numbers below were tuned on four models of 700 to 2000 triangles;
// none of them matters much.
namespace orchard::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Index kBatch = 16;
constexpr int kRounds = 3;  // of sharing out
constexpr int kFirstEvaluations = 5, kLastEvaluations = 12;
constexpr double kMoveShare = 0.35;  // of trials that move a cheap ball to a dear place
constexpr Index kFewForMoves = 8;    // balls, up to which there is no such move

}  // namespace

// A ball, loose ones more often, and some neighbours; perhaps also a tight one from anywhere that is to move here, with
// the neighbours that must stand in for it.
std::vector<Index> LevelSolver::choose(Random& random, Index& moved) const {
  const auto count = static_cast<Index>(balls_.size());
  std::vector<Index> chosen;
  const auto pick = [&](std::uint64_t tournament, bool loose) {
    Index best = static_cast<Index>(random.below(count));
    for (std::uint64_t i = 1; i < tournament; ++i) {
      const Index other = static_cast<Index>(random.below(count));
      if ((balls_[other].looseness() > balls_[best].looseness()) == loose) best = other;
    }
    return best;
  };
  const auto has = [&](Index b) { return std::find(chosen.begin(), chosen.end(), b) != chosen.end(); };
  const auto add_neighbors = [&](Index of, std::size_t how_many) {
    std::vector<std::pair<double, Index>> near;
    for (Index b = 0; b < count; ++b) {
      const double apart = (balls_[b].center - balls_[of].center).norm() - 0.5 * balls_[b].radius;
      if (b != of) near.emplace_back(apart * random.uniform(0.8, 1.25), b);
    }
    how_many = std::min(how_many, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(how_many), near.end());
    for (std::size_t i = 0; i < how_many; ++i)
      if (!has(near[i].second)) chosen.push_back(near[i].second);
  };
  chosen.push_back(pick(1 + random.below(3), true));
  add_neighbors(chosen[0], 1 + random.below(5));
  moved = kNone;
  if (count <= kFewForMoves || random.uniform() >= kMoveShare) return chosen;
  const Index cheap = pick(4, false);
  if (has(cheap)) return chosen;
  moved = static_cast<Index>(chosen.size());
  chosen.push_back(cheap);
  add_neighbors(cheap, 1 + random.below(3));
  return chosen;
}

std::vector<Index> LevelSolver::held_only_by(const std::vector<Index>& chosen) const {
  std::vector<Index> held, only;
  for (Index b : chosen) held.insert(held.end(), balls_[b].samples.begin(), balls_[b].samples.end());
  std::sort(held.begin(), held.end());
  for (std::size_t i = 0, end = 0; i < held.size(); i = end) {
    while (end < held.size() && held[end] == held[i]) ++end;
    if (end - i == holders_[held[i]]) only.push_back(held[i]);
  }
  return only;
}

void LevelSolver::reseed(LevelBall& ball, Index sample, Random& random) const {
  ball.center = samples_.starts[sample];
  if (random.uniform() < 0.3) ball.center = 0.5 * (ball.center + samples_.points[sample]);
  ball.depth = surface_.signed_distance(ball.center);
  ball.region = regions_of_[sample][random.below(regions_of_[sample].size())];
}

// Lloyd's iteration among the trial's balls. False: a sample fits none of their regions, or a ball is left unused.
bool LevelSolver::share_out(Trial& trial, const std::vector<Index>& freed, int rounds, Random& random) const {
  std::vector<std::vector<Point>>& own = trial.needs;
  own.resize(trial.balls.size());
  BallFitter fitter(surface_);
  bool all_used = true;
  for (int round = 1; round <= rounds; ++round) {
    for (auto& list : own) list.clear();
    for (Index s : freed) {
      double min = kInfinity;
      std::size_t at = kNone;
      for (std::size_t b = 0; b < trial.balls.size(); ++b) {
        if (!in_region(trial.balls[b].region, s)) continue;
        const double k = key(trial.balls[b], s);
        if (k < min) min = k, at = b;
      }
      if (at == kNone) return false;
      own[at].push_back(samples_.points[s]);
    }
    all_used = true;
    for (std::size_t b = 0; b < trial.balls.size(); ++b) {
      LevelBall& ball = trial.balls[b];
      if (own[b].empty()) {
        all_used = false;
        reseed(ball, freed[random.below(freed.size())], random);
        continue;
      }
      const int evaluations = round == rounds ? kLastEvaluations : kFirstEvaluations;
      static_cast<FittedBall&>(ball) = fitter.fit(own[b], ball.center, evaluations);
    }
  }
  return all_used;
}

LevelSolver::Trial LevelSolver::propose(std::uint64_t number, const LevelCover* cover) const {
  Random random(options_.seed, 200 + options_.level, number);
  Trial trial;
  Index moved = kNone;
  trial.chosen = choose(random, moved);
  const std::vector<Index> freed = held_only_by(trial.chosen);
  if (freed.empty()) return trial;
  double before = 0;
  for (Index b : trial.chosen) {
    before += cost(balls_[b]);
    LevelBall& copy = trial.balls.emplace_back();
    static_cast<FittedBall&>(copy) = balls_[b];
    copy.region = balls_[b].region;
  }
  if (moved != kNone) {
    const auto& there = balls_[trial.chosen[0]].samples;
    reseed(trial.balls[moved], there.empty() ? freed[0] : there[random.below(there.size())], random);
  }
  const double fresh = moved != kNone ? 0.15 : random.uniform() < 0.3 ? 1.0 : 0.4;
  for (std::size_t i = 0; i < trial.balls.size(); ++i)
    if (i != moved && random.uniform() < fresh) reseed(trial.balls[i], freed[random.below(freed.size())], random);

  double after = 0;
  const bool shared = share_out(trial, freed, kRounds, random);
  for (const LevelBall& ball : trial.balls) after += cost(ball);
  trial.moved = moved;
  if (!shared || !(after < before * (1 - 1e-6)) || (cover != nullptr && !close_trial(trial, before, *cover))) {
    trial.balls.clear();
    return trial;
  }
  for (LevelBall& ball : trial.balls) find_members(ball);
  return trial;
}

// What a trial was judged by are the balls that meet its own, old and new.
bool LevelSolver::near_any(const Trial& trial, const std::vector<Sphere>& changed) const {
  const auto meets = [&](const FittedBall& ball) {
    return std::any_of(changed.begin(), changed.end(), [&](const Sphere& other) {
      return (other.center - ball.center).norm() <= (other.radius + ball.radius) * (1 + 1e-9);
    });
  };
  return std::any_of(trial.balls.begin(), trial.balls.end(), meets) ||
         std::any_of(trial.chosen.begin(), trial.chosen.end(), [&](Index b) { return meets(balls_[b]); });
}

// Puts the trial's balls in place, unless a sample would be lost or a region gets too many, because another trial of
// the batch was faster.
bool LevelSolver::apply(Trial& trial) {
  if (trial.balls.empty()) return false;
  std::vector<LevelBall>& fresh = trial.balls;
  const auto swap_in = [&] {
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      LevelBall& old = balls_[trial.chosen[i]];
      for (Index s : old.samples) --holders_[s];
      for (Index s : fresh[i].samples) ++holders_[s];
      --children_[old.region];
      ++children_[fresh[i].region];
      std::swap(old, fresh[i]);
    }
  };
  swap_in();
  bool holds = true;
  for (const LevelBall& old : fresh)
    for (Index s : old.samples) holds = holds && holders_[s] > 0;
  for (Index b : trial.chosen) holds = holds && children_[balls_[b].region] <= options_.max_children;
  if (!holds) swap_in();
  return holds;
}

void LevelSolver::search(Index trials, const Progress& progress) { run_trials(trials, nullptr, progress); }

void LevelSolver::run_trials(Index trials, LevelCover* cover, const Progress& progress) {
  if (balls_.size() < 2) return;
  std::vector<Trial> batch(kBatch);
  std::vector<Sphere> changed;
  std::vector<char> taken(balls_.size());
  for (Index done = 0; done < trials; done += kBatch) {
    report_progress(progress, "searching", static_cast<double>(done) / trials);
    tbb::parallel_for(Index{0}, kBatch, [&](Index i) { batch[i] = propose(trials_ + i, cover); });
    trials_ += kBatch;
    changed.clear();
    std::fill(taken.begin(), taken.end(), 0);
    for (Trial& trial : batch) {
      const bool free = std::none_of(trial.chosen.begin(), trial.chosen.end(), [&](Index b) { return taken[b] != 0; });
      if (trial.balls.empty() || !free || (cover != nullptr && near_any(trial, changed))) continue;
      std::vector<Sphere> before;
      for (Index b : trial.chosen) before.push_back({balls_[b].center, balls_[b].radius});
      if (!apply(trial)) continue;
      changed.insert(changed.end(), before.begin(), before.end());
      for (Index b : trial.chosen) {
        taken[b] = 1;
        changed.push_back({balls_[b].center, balls_[b].radius});
        if (cover != nullptr) cover->replace(b, {changed.back(), balls_[b].region});
      }
    }
  }
}

}  // namespace orchard::detail
