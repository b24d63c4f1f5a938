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
  std::vector<Point> points;
  for (Index b : order) {
    const RegionBall old = cover.balls()[b];
    arcs.clear();
    cover.open_arcs(old.sphere, {{&b, 1}, {}}, scratch, arcs);
    if (arcs.empty()) continue;
    points.clear();
    for (const OpenArc& arc : arcs) points.insert(points.end(), {arc.begin, arc.end});
    FittedBall fitted = fitter.fit(points, balls_[b].center, kEvaluations);
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

// What the trial leaves open goes to those of its balls that it costs least, until nothing is open or nothing gained.
bool LevelSolver::close_trial(Trial& trial, double before, const LevelCover& cover) const {
  const double margin = tolerance::kCoverMargin * surface_.bounding_radius();
  const std::span<const Index> chosen(trial.chosen);
  const std::size_t count = trial.balls.size();
  std::vector<Sphere> where;
  if (trial.moved == kNone) {
    where.push_back(around(balls_, chosen));
  } else {
    where = {around(balls_, chosen.first(trial.moved)), around(balls_, chosen.subspan(trial.moved))};
  }
  std::vector<RegionBall> added(count);
  const auto put = [&](std::size_t i) {
    added[i] = {{trial.balls[i].center, trial.balls[i].radius}, trial.balls[i].region};
  };
  for (std::size_t i = 0; i < count; ++i) {
    trial.balls[i].radius += margin;
    put(i);
  }
  BallFitter fitter(surface_);
  LevelCover::Scratch scratch;
  std::vector<OpenArc> arcs;
  const auto total = [&] {
    double sum = 0;
    for (const LevelBall& ball : trial.balls) sum += cost(ball);
    return sum;
  };
  const double most = before * (1 - 1e-6);
  bool closed = false;
  for (int round = 0; round < kRounds && !closed; ++round) {
    arcs.clear();
    for (const Sphere& sphere : where) cover.open_arcs(sphere, {chosen, added}, scratch, arcs);
    closed = arcs.empty();
    if (closed) break;
    std::vector<char> grown(count, 0);
    for (const OpenArc& arc : arcs) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t taker = kNone;
      for (std::size_t i = 0; i < count; ++i) {
        const LevelBall& ball = trial.balls[i];
        FittedBall larger = ball;
        larger.radius = std::max({ball.radius, (arc.begin - ball.center).norm(), (arc.end - ball.center).norm()});
        const double rise = cost(larger) - cost(ball) + 1e-12 * larger.radius / surface_.bounding_radius();
        if (rise >= least || !cover.in_region(ball.region, arc.begin) || !cover.in_region(ball.region, arc.end))
          continue;
        least = rise;
        taker = i;
      }
      if (taker == kNone) return false;
      trial.needs[taker].insert(trial.needs[taker].end(), {arc.begin, arc.end});
      grown[taker] = 1;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!grown[i]) continue;
      static_cast<FittedBall&>(trial.balls[i]) = fitter.fit(trial.needs[i], trial.balls[i].center, kEvaluations);
      trial.balls[i].radius += margin * (round + 1);
      put(i);
    }
    if (total() >= most) return false;
  }
  if (!closed) return false;
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<RegionBall> others = added;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    arcs.clear();
    cover.open_arcs(added[i].sphere, {chosen, others}, scratch, arcs);
    if (arcs.empty()) continue;
    points.clear();
    for (const OpenArc& arc : arcs) points.insert(points.end(), {arc.begin, arc.end});
    FittedBall fitted = fitter.fit(points, trial.balls[i].center, kEvaluations);
    fitted.radius += margin;
    if (fitted.looseness() > trial.balls[i].looseness() * (1 - kWorthwhile)) continue;
    static_cast<FittedBall&>(trial.balls[i]) = fitted;
    put(i);
  }
  if (total() >= most) return false;
  return std::all_of(where.begin(), where.end(), [&](const Sphere& sphere) {
    return cover.covered(sphere, {chosen, added}, scratch);
  });
}

}  // namespace orchard::detail
