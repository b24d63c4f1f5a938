#include "level_solver.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace orchard::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A sample that decided a radius is inside, whatever the rounding.
constexpr double kInside = 1 + 1e-12;
constexpr int kLloydRounds = 8;
constexpr int kLloydEvaluations = 8, kTightenEvaluations = 14;

}  // namespace

LevelSolver::LevelSolver(const Surface& surface, Samples samples, std::vector<std::vector<Sphere>> paths,
                         const LevelOptions& options)
    : surface_(surface), paths_(std::move(paths)), options_(options) {
  regions_.resize(paths_.size());
  children_.assign(paths_.size(), 0);
  std::vector<std::vector<Index>> regions_of(samples.size());
  tbb::parallel_for(Index{0}, samples.size(), [&](Index s) {
    for (Index r = 0; r < paths_.size(); ++r)
      if (in_path(r, samples.points[s])) regions_of[s].push_back(r);
  });
  for (Index s = 0; s < samples.size(); ++s) {
    if (regions_of[s].empty()) continue;
    for (Index r : regions_of[s]) regions_[r].push_back(samples_.size());
    samples_.points.push_back(samples.points[s]);
    samples_.starts.push_back(samples.starts[s]);
    regions_of_.push_back(std::move(regions_of[s]));
  }
}

bool LevelSolver::in_path(Index region, const Point& point) const {
  return std::all_of(paths_[region].rbegin(), paths_[region].rend(), [&](const Sphere& ball) {
    return (point - ball.center).squaredNorm() <= ball.radius * ball.radius;
  });
}

bool LevelSolver::in_region(Index region, Index sample) const {
  const auto& list = regions_of_[sample];
  return std::find(list.begin(), list.end(), region) != list.end();
}

double LevelSolver::cost(const FittedBall& ball) const {
  const LevelCost& by = options_.cost;
  const double t = std::max(0.0, ball.looseness()) / by.unit;
  double cost = std::pow(t, by.power);
  if (by.cap > 0) cost *= 1 + std::pow(t / by.cap, by.cap_power);
  if (by.size_power > 0) cost *= std::pow(ball.radius / surface_.bounding_radius(), by.size_power);
  return cost;
}

double LevelSolver::objective() const {
  double sum = 0;
  for (const LevelBall& ball : balls_) sum += cost(ball);
  return sum;
}

void LevelSolver::find_members(LevelBall& ball) const {
  ball.samples.clear();
  const double limit = ball.radius * ball.radius * kInside;
  for (Index s : regions_[ball.region])
    if ((samples_.points[s] - ball.center).squaredNorm() <= limit) ball.samples.push_back(s);
}

void LevelSolver::recount() {
  holders_.assign(samples_.size(), 0);
  children_.assign(paths_.size(), 0);
  for (const LevelBall& ball : balls_) {
    for (Index s : ball.samples) ++holders_[s];
    ++children_[ball.region];
  }
}

void LevelSolver::replace(Index index, const FittedBall& fitted) {
  LevelBall& ball = balls_[index];
  for (Index s : ball.samples) --holders_[s];
  static_cast<FittedBall&>(ball) = fitted;
  find_members(ball);
  for (Index s : ball.samples) ++holders_[s];
}

// The region with room that holds most of the samples near a seed; kNone if all are full.
Index LevelSolver::region_for_seed(const FittedBall& seed, Index sample) const {
  const double near = 1.2 * (samples_.points[sample] - seed.center).norm();
  Index best = kNone, max = 0;
  for (Index r : regions_of_[sample]) {
    if (children_[r] >= options_.max_children) continue;
    Index held = 0;
    for (Index s : regions_[r]) held += (samples_.points[s] - seed.center).squaredNorm() <= near * near;
    if (best == kNone || held > max) best = r, max = held;
  }
  return best;
}

// Each seed is where the balls so far would have to be loosest; then Lloyd's iteration.
void LevelSolver::start() {
  if (samples_.size() == 0) return;
  std::vector<double> min(samples_.size(), kInfinity);
  Index next = static_cast<Index>(Random(options_.seed, 100 + options_.level).below(samples_.size()));
  for (Index seeds = 0; seeds < samples_.size() && balls_.size() < options_.balls; ++seeds) {
    LevelBall ball;
    ball.center = samples_.starts[next];
    ball.depth = surface_.signed_distance(ball.center);
    ball.region = region_for_seed(ball, next);
    if (ball.region != kNone) {
      for (Index s : regions_[ball.region]) min[s] = std::min(min[s], key(ball, s));
      ++children_[ball.region];
      balls_.push_back(ball);
    }
    min[next] = -kInfinity;
    next = static_cast<Index>(std::max_element(min.begin(), min.end()) - min.begin());
  }
  for (int round = 0; round < kLloydRounds; ++round) lloyd_round();
  drop_unused();
  for (LevelBall& ball : balls_) find_members(ball);
  recount();
  if (options_.cost.unit > 0) return;
  for (const LevelBall& ball : balls_) options_.cost.unit += ball.looseness() / static_cast<double>(balls_.size());
  if (!(options_.cost.unit > 0)) options_.cost.unit = surface_.bounding_radius();
}

// The ball that gets least loose by each sample.
std::vector<Index> LevelSolver::owners() const {
  std::vector<std::vector<Index>> in_region_of(regions_.size());
  for (Index b = 0; b < balls_.size(); ++b) in_region_of[balls_[b].region].push_back(b);
  std::vector<Index> owner(samples_.size(), kNone);
  tbb::parallel_for(Index{0}, samples_.size(), [&](Index s) {
    double min = kInfinity;
    for (Index r : regions_of_[s])
      for (Index b : in_region_of[r]) {
        const double k = key(balls_[b], s);
        if (k < min) min = k, owner[s] = b;
      }
  });
  return owner;
}

void LevelSolver::assign(const std::vector<Index>& owner) {
  for (LevelBall& ball : balls_) ball.samples.clear();
  for (Index s = 0; s < samples_.size(); ++s)
    if (owner[s] != kNone) balls_[owner[s]].samples.push_back(s);
}

void LevelSolver::lloyd_round() {
  for (LevelBall& ball : balls_)
    if (ball.samples.empty() && ball.radius < 0) split_loosest(ball);
  assign(owners());
  tbb::enumerable_thread_specific<BallFitter> fitters([&] { return BallFitter(surface_); });
  tbb::parallel_for(std::size_t{0}, balls_.size(), [&](std::size_t b) {
    LevelBall& ball = balls_[b];
    ball.radius = -1;  // unused
    if (ball.samples.empty()) return;
    std::vector<Point> points;
    for (Index s : ball.samples) points.push_back(samples_.points[s]);
    static_cast<FittedBall&>(ball) = fitters.local().fit(points, ball.center, kLloydEvaluations);
  });
}

void LevelSolver::split_loosest(LevelBall& unused) {
  const auto looser = [](const LevelBall& a, const LevelBall& b) { return a.looseness() < b.looseness(); };
  const LevelBall& loosest = *std::max_element(balls_.begin(), balls_.end(), looser);
  if (loosest.samples.empty() || children_[loosest.region] >= options_.max_children) return;
  const Index far = *std::max_element(loosest.samples.begin(), loosest.samples.end(), [&](Index a, Index b) {
    return (samples_.points[a] - loosest.center).squaredNorm() < (samples_.points[b] - loosest.center).squaredNorm();
  });
  --children_[unused.region];
  ++children_[loosest.region];
  unused.region = loosest.region;
  unused.center = samples_.starts[far];
  unused.depth = surface_.signed_distance(unused.center);
}

void LevelSolver::drop_unused() {
  std::erase_if(balls_, [](const LevelBall& ball) { return ball.samples.empty(); });
}

void LevelSolver::tighten() {
  std::vector<Index> order(balls_.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return balls_[a].looseness() > balls_[b].looseness(); });
  BallFitter fitter(surface_);
  std::vector<Point> points;
  for (Index b : order) {
    points.clear();
    for (Index s : balls_[b].samples)
      if (holders_[s] == 1) points.push_back(samples_.points[s]);
    if (points.empty()) continue;
    const FittedBall fitted = fitter.fit(points, balls_[b].center, kTightenEvaluations);
    if (fitted.looseness() < balls_[b].looseness()) replace(b, fitted);
  }
}

}  // namespace orchard::detail
