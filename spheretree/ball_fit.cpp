#include "ball_fit.h"

#include <algorithm>
#include <cmath>

#include "infinity.h"
#include "wide.h"

namespace orchard::detail {
namespace {

constexpr int kDualSteps = 24;
// A predicted gain that is a smaller share of the looseness than this is not worth another query.
constexpr double kWorthwhileGain = 2e-4;
// As a share of the radius: smaller steps do not matter.
constexpr double kMinFitStep = 1e-4;
// The factor by which the distance to a known point of the surface may exceed the distance to the surface. If it may be
// larger, the nearest point is searched again.
constexpr double kKnownPointFactor = 1 + 1e-9;

}  // namespace

template <std::size_t kRoom>
void BallFitter::Terms<kRoom>::add(double term, const Vector& gradient) {
  const std::size_t block = count / kLanes, lane = count % kLanes;
  value[block][lane] = term;
  x[block][lane] = gradient.x();
  y[block][lane] = gradient.y();
  z[block][lane] = gradient.z();
  ++count;
}

template <std::size_t kRoom>
void BallFitter::Terms<kRoom>::fill_up() {
  const std::size_t real = count;
  while (count % kLanes != 0) add(-kInfinity, Vector::Zero());
  count = real;
}

template <std::size_t kRoom>
Vector BallFitter::Terms<kRoom>::gradient(std::size_t i) const {
  return {x[i / kLanes][i % kLanes], y[i / kLanes][i % kLanes], z[i / kLanes][i % kLanes]};
}

template <std::size_t kRoom>
Vector BallFitter::Terms<kRoom>::start_weights() {
  std::size_t top = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (value[i / kLanes][i % kLanes] > value[top / kLanes][top % kLanes]) top = i;
  weighted[0] = top;
  weight[top] = 1;
  weighted_count = 1;
  return gradient(top);
}

// Takes one step of maximising sum w_i value_i - t/2 |sum w_i gradient_i|^2 over weights that sum to one: it moves
// weight from the term that wants it least to the one that wants it most. Returns how far apart these two are. The sum
// is over the terms of both kinds.
template <std::size_t kRoom>
double BallFitter::Terms<kRoom>::shift_weight(Vector& sum, double t) {
  const double tx = t * sum.x(), ty = t * sum.y(), tz = t * sum.z();
  double scores[kRoom];
  // The highest value of each lane, and its block, which is the first one if several have that value.
  Lanes lane_highest = Lanes{} - kInfinity, lane_block{};
  for (std::size_t b = 0; b * kLanes < count; ++b) {
    const Lanes score = value[b] - (tx * x[b] + ty * y[b] + tz * z[b]);
    const auto higher = score > lane_highest;
    lane_highest = higher ? score : lane_highest;
    lane_block = higher ? Lanes{} + static_cast<double>(b) : lane_block;
    for (std::size_t k = 0; k < kLanes; ++k) scores[kLanes * b + k] = score[k];
  }
  std::size_t up = 0, place = 0;
  double highest = -kInfinity, lowest = kInfinity;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const std::size_t i = kLanes * static_cast<std::size_t>(lane_block[k]) + k;
    if (lane_highest[k] > highest || (lane_highest[k] == highest && i < up)) highest = lane_highest[k], up = i;
  }
  for (std::size_t k = 0; k < weighted_count; ++k) {
    const double score = scores[weighted[k]];
    if (score < lowest || (score == lowest && weighted[k] < weighted[place])) lowest = score, place = k;
  }
  const std::size_t down = weighted[place];
  if (up == down) return 0;
  const double apart = highest - lowest;
  const Vector change = gradient(up) - gradient(down);
  const double curvature = t * change.squaredNorm();
  const bool all = curvature * weight[down] <= apart;
  const double amount = all ? weight[down] : apart / curvature;
  weight[down] = all ? 0 : weight[down] - amount;
  if (!(weight[down] > 0)) weighted[place] = weighted[--weighted_count];
  if (amount > 0) {
    const auto end = weighted + weighted_count;
    const bool fresh = std::find(weighted, end, up) == end;
    if (fresh) weighted[weighted_count++] = up;
    weight[up] = fresh ? amount : weight[up] + amount;
  }
  sum += amount * change;
  return apart;
}

template <std::size_t kRoom>
double BallFitter::Terms<kRoom>::max_after(const Vector& step) const {
  double max = -kInfinity;
  for (std::size_t b = 0; b * kLanes < count; ++b) {
    const Lanes after = value[b] + (step.x() * x[b] + step.y() * y[b] + step.z() * z[b]);
    for (std::size_t k = 0; k < kLanes; ++k) max = std::max(max, after[k]);
  }
  return max;
}

// The surface is at most as far away as the point of it that was nearest to the last centre, which bounds the search.
ClosestPoint BallFitter::closest(const Point& center) const {
  const Cut& last = cuts_.back();
  const Point known = last.at - last.value * last.gradient;
  const ClosestPoint nearest = surface_.closest_within(center, (center - known).norm() * kKnownPointFactor);
  return nearest.triangle == kNone ? surface_.closest(center) : nearest;
}

// Closer to a centre than its distance from the surface, the side is the same as the centre's. That saves the query.
BallFitter::Cut BallFitter::cut_at(const Point& center) const {
  if (measure_ == BallMeasure::radius) return {center, 0, Vector::Zero()};
  ClosestPoint nearest;
  double center_distance = 0;
  const bool same_side = !cuts_.empty() && (center - cuts_.back().at).norm() < 0.999 * std::abs(cuts_.back().value);
  if (same_side) {
    nearest = closest(center);
    center_distance = cuts_.back().value < 0 ? -nearest.distance : nearest.distance;
  } else {
    center_distance = surface_.signed_distance(center, nearest);
  }
  const Vector away = center - nearest.position;
  const double length = away.norm();
  if (!(length > 0)) return {center, center_distance, surface_.pseudonormal(nearest.triangle, nearest.feature)};
  return {center, center_distance, away / (center_distance < 0 ? -length : length)};
}

FittedBall BallFitter::at(const Point& center) const {
  const Cut cut = cut_at(center);
  return {center, 0, cut.value, cut.gradient};
}

void BallFitter::take_points(std::span<const Point> points) {
  point_count_ = points.size();
  points_.resize((points.size() + kLanes - 1) / kLanes);
  squared_.resize(points_.size());
  measured_.resize(points_.size());
  for (std::size_t i = 0; i < kLanes * points_.size(); ++i) {
    const Point& p = points[std::min(i, points.size() - 1)];
    FourPoints& four = points_[i / kLanes];
    four.x[i % kLanes] = p.x();
    four.y[i % kLanes] = p.y();
    four.z[i % kLanes] = p.z();
  }
}

// Returns the radius that contains all points.
double BallFitter::measure(const Point& center) {
  Lanes max{};
  for (std::size_t b = 0; b < points_.size(); ++b) {
    const Lanes dx = points_[b].x - center.x(), dy = points_[b].y - center.y(), dz = points_[b].z - center.z();
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    measured_[b].numbers = squared;
    max = squared > max ? squared : max;
  }
  return std::sqrt(std::max(std::max(max[0], max[1]), std::max(max[2], max[3]))) * (1 + 0x1p-50);
}

void BallFitter::linearise_points(const FittedBall& ball, double reach) {
  const double min = std::max(0.0, ball.radius - 2 * reach);
  farthest_.take(squared_, point_count_, min * min, ball.radius * ball.radius);
  far_.count = 0;
  for (std::size_t i = 0; i < farthest_.count(); ++i) {
    const FourPoints& four = points_[farthest_.point(i) / kLanes];
    const std::size_t lane = farthest_.point(i) % kLanes;
    const double length = std::sqrt(farthest_.squared(i));
    far_.add(length, (ball.center - Point(four.x[lane], four.y[lane], four.z[lane])) / length);
  }
  if (farthest_.count() == 0) far_.add(ball.radius, Vector::Zero());
  far_.fill_up();
}

void BallFitter::linearise(const FittedBall& ball, double reach) {
  linearise_points(ball, reach);
  // The surface is not convex, so a cut may claim a larger value than is known here. Such a cut does not hold here.
  const auto value_here = [&](const Cut& cut) { return cut.value + cut.gradient.dot(ball.center - cut.at); };
  std::erase_if(cuts_, [&](const Cut& cut) { return value_here(cut) > ball.center_distance + 1e-9 * ball.radius; });
  near_.count = 0;
  for (const Cut& cut : cuts_) near_.add(value_here(cut), cut.gradient);
  if (cuts_.empty()) near_.add(ball.center_distance, Vector::Zero());
  near_.fill_up();
}

// Finds the step that minimises max far + max near + |step|^2 / (2 t), by the dual problem.
Vector BallFitter::best_step(double t) {
  Vector sum = far_.start_weights() + near_.start_weights();
  for (int k = 0; k < kDualSteps; ++k)
    if (far_.shift_weight(sum, t) + near_.shift_weight(sum, t) < 1e-4 * t) break;
  return -t * sum;
}

FittedBall BallFitter::fit(std::span<const Point> points, const FittedBall& start, int evaluations) {
  return wide() ? fit_wide(points, start, evaluations) : fit_here(points, start, evaluations);
}

ORCHARD_FOR_AVX2 FittedBall BallFitter::fit_wide(std::span<const Point> points, const FittedBall& start,
                                                 int evaluations) {
  return fit_here(points, start, evaluations);
}

FittedBall BallFitter::fit_here(std::span<const Point> points, const FittedBall& start, int evaluations) {
  take_points(points);
  cuts_.assign(1, {start.center, start.center_distance, start.slope});
  if (start.slope.isZero(0)) cuts_.clear(), cuts_.push_back(cut_at(start.center));
  FittedBall best{start.center, measure(start.center), cuts_.back().value, cuts_.back().gradient};
  squared_.swap(measured_);
  double t = 0.3 * best.looseness() + 0.05 * best.radius;
  for (int used = 1; used < evaluations && t > kMinFitStep * best.radius;) {
    linearise(best, t);
    const Vector step = best_step(t);
    const double length = step.norm(), predicted = best.looseness() - predicted_looseness(step);
    if (predicted <= 0 || length < kMinFitStep * kWorthwhileGain * best.radius) break;
    FittedBall next{best.center + step, 0, 0, Vector::Zero()};
    next.radius = measure(next.center);
    // The distance changes by at most the length of the step. If even that would not help, no query is needed.
    if (next.radius + best.center_distance - length >= best.looseness()) {
      t /= 4;
      continue;
    }
    ++used;
    if (cuts_.size() == kMaxCuts) cuts_.erase(cuts_.begin());
    cuts_.push_back(cut_at(next.center));
    next.center_distance = cuts_.back().value;
    next.slope = cuts_.back().gradient;
    const double gain = best.looseness() - next.looseness();
    if (gain > 0) {
      best = next;
      squared_.swap(measured_);
    }
    if (predicted < kWorthwhileGain * best.looseness()) break;
    t *= gain > 0.6 * predicted ? 1.7 : gain < 0.2 * predicted ? 1.0 / 3 : 1.0;
  }
  return best;
}

}  // namespace orchard::detail
