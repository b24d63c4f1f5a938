#include "ball_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

constexpr std::size_t kMaxCuts = 12;
constexpr std::size_t kMaxFar = 40;  // farthest points that a step looks at
constexpr int kDualSteps = 24;
// A predicted gain below this part of the looseness is not worth another query.
constexpr double kWorthwhile = 2e-4;
// Steps below this part of the radius change nothing that matters.
constexpr double kMin = 1e-4;

double radius_for(std::span<const Point> points, const Point& center) {
  double squared = 0;
  for (const Point& p : points) squared = std::max(squared, (p - center).squaredNorm());
  return std::sqrt(squared) * (1 + 0x1p-50);
}

// One step of maximising sum w_i value_i - t/2 |sum w_i gradient_i|^2 + .. over weights that sum to one: weight moves
// from the least to the most wanted term. Returns how far apart these were; `sum` is over the terms of both kinds.
template <class Terms>
double shift_weight(const Terms& terms, std::vector<double>& weights, Vector& sum, double t) {
  std::size_t up = 0, down = 0;
  double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double value = terms[i].value - t * terms[i].gradient.dot(sum);
    if (value > highest) highest = value, up = i;
    if (weights[i] > 0 && value < lowest) lowest = value, down = i;
  }
  if (up == down) return 0;
  const Vector change = terms[up].gradient - terms[down].gradient;
  const double curvature = t * change.squaredNorm();
  const bool all = curvature * weights[down] <= highest - lowest;
  const double amount = all ? weights[down] : (highest - lowest) / curvature;
  weights[up] += amount;
  weights[down] = all ? 0 : weights[down] - amount;
  sum += amount * change;
  return highest - lowest;
}

template <class Terms>
Vector start_weights(const Terms& terms, std::vector<double>& weights) {
  weights.assign(terms.size(), 0);
  std::size_t top = 0;
  for (std::size_t i = 1; i < terms.size(); ++i)
    if (terms[i].value > terms[top].value) top = i;
  weights[top] = 1;
  return terms[top].gradient;
}

}  // namespace

BallFitter::Cut BallFitter::cut_at(const Point& center) const {
  ClosestPoint nearest;
  const double center_distance = surface_.signed_distance(center, nearest);
  const Vector away = center - nearest.position;
  const double length = away.norm();
  if (!(length > 0)) return {center, center_distance, surface_.pseudonormal(nearest.triangle, nearest.feature)};
  return {center, center_distance, away / (center_distance < 0 ? -length : length)};
}

void BallFitter::linearise(std::span<const Point> points, const FittedBall& ball, double reach) {
  far_.clear();
  const double min = std::max(0.0, ball.radius - 2 * reach);
  for (const Point& p : points) {
    const Vector away = ball.center - p;
    const double squared = away.squaredNorm();
    if (squared < min * min || squared == 0) continue;
    const double length = std::sqrt(squared);
    far_.push_back({length, away / length});
  }
  if (far_.empty()) far_.push_back({ball.radius, Vector::Zero()});
  if (far_.size() > kMaxFar) {
    std::nth_element(far_.begin(), far_.begin() + kMaxFar, far_.end(),
                     [](const Term& a, const Term& b) { return a.value > b.value; });
    far_.resize(kMaxFar);
  }
  // A cut that claims more than the distance known here does not hold here: the surface is not convex.
  const auto value_here = [&](const Cut& cut) { return cut.value + cut.gradient.dot(ball.center - cut.at); };
  std::erase_if(cuts_, [&](const Cut& cut) { return value_here(cut) > ball.center_distance + 1e-9 * ball.radius; });
  near_.clear();
  for (const Cut& cut : cuts_) near_.push_back({value_here(cut), cut.gradient});
  if (near_.empty()) near_.push_back({ball.center_distance, Vector::Zero()});
}

// Minimises max far + max near + |step|^2 / (2 t) over the step, through the dual.
Vector BallFitter::best_step(double t) {
  Vector sum = start_weights(far_, far_weight_) + start_weights(near_, near_weight_);
  for (int k = 0; k < kDualSteps; ++k)
    if (shift_weight(far_, far_weight_, sum, t) + shift_weight(near_, near_weight_, sum, t) < 1e-4 * t) break;
  return -t * sum;
}

double BallFitter::predicted_looseness(const Vector& step) const {
  double far = -std::numeric_limits<double>::infinity(), near = far;
  for (const Term& term : far_) far = std::max(far, term.value + term.gradient.dot(step));
  for (const Term& term : near_) near = std::max(near, term.value + term.gradient.dot(step));
  return far + near;
}

FittedBall BallFitter::fit(std::span<const Point> points, const Point& start, int evaluations) {
  cuts_.assign(1, cut_at(start));
  FittedBall best{start, radius_for(points, start), cuts_.back().value};
  double t = 0.3 * best.looseness() + 0.05 * best.radius;
  for (int used = 1; used < evaluations && t > kMin * best.radius;) {
    linearise(points, best, t);
    const Vector step = best_step(t);
    const double length = step.norm(), predicted = best.looseness() - predicted_looseness(step);
    if (predicted <= 0 || length < kMin * kWorthwhile * best.radius) break;
    FittedBall next{best.center + step, 0, 0};
    next.radius = radius_for(points, next.center);
    // The distance changes by no more than the step: no need to look where even that would not help.
    if (next.radius + best.center_distance - length >= best.looseness()) {
      t /= 4;
      continue;
    }
    ++used;
    if (cuts_.size() == kMaxCuts) cuts_.erase(cuts_.begin());
    cuts_.push_back(cut_at(next.center));
    next.center_distance = cuts_.back().value;
    const double gain = best.looseness() - next.looseness();
    if (gain > 0) best = next;
    if (predicted < kWorthwhile * best.looseness()) break;
    t *= gain > 0.6 * predicted ? 1.7 : gain < 0.2 * predicted ? 1.0 / 3 : 1.0;
  }
  return best;
}

}  // namespace orchard::detail
