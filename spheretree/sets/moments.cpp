#include "moments.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace orchard::detail {
namespace {

constexpr int kRows = 10;
using Row = Eigen::Matrix<double, kRows, 1>;
using Square = Eigen::Matrix<double, kRows, kRows>;

// The regularization of the dual problem. It is so small that the moments are met as nearly as doubles allow.
constexpr double kMissed = 1e-10;
constexpr int kMaxSteps = 200, kMaxStepHalvings = 40;
constexpr double kConverged = 1e-13;

// For each ball, per weight: the moments about the body's centre, minus the body's own, so that their weighted sums are
// to be 0; the last entry is the weight itself, if the sum is to be kept.
std::vector<Row> rows_of(std::span<const Sphere> balls, const MassProperties& body, bool keep_sum) {
  const Eigen::Matrix3d wanted = second_moment(body);
  const double size = std::sqrt(std::max(1e-300, wanted.trace()));
  std::vector<Row> rows;
  for (const Sphere& ball : balls) {
    const Vector at = (ball.center - body.center) / size;
    const double own = ball.radius * ball.radius / (5 * size * size);
    const Eigen::Matrix3d moment = at * at.transpose() + own * Eigen::Matrix3d::Identity() - wanted / (size * size);
    Row row;
    row << at, moment.diagonal(), moment(0, 1), moment(0, 2), moment(1, 2), keep_sum ? 1 : 0;
    rows.push_back(row);
  }
  return rows;
}

// The dual problem. The weights are clamp(wanted (1 + row . x)), and x is sought such that missed(x) = 0.
class Dual {
 public:
  Dual(std::vector<Row> rows, const WeightBounds& bounds) : rows_(std::move(rows)), bounds_(bounds) {
    const double sum = std::accumulate(bounds.wanted.begin(), bounds.wanted.end(), 0.0);
    for (double weight : bounds.wanted) parts_.push_back(weight / sum);
    sum_ = sum;
  }

  std::vector<double> solve() const {
    Row x = Row::Zero();
    for (int step = 0; step < kMaxSteps; ++step) {
      const Row slope = missed(x);
      if (slope.norm() < kConverged) break;
      const Row direction = -jacobian(x).ldlt().solve(slope);
      const double before = value(x), fall = slope.dot(direction);
      double length = 1;
      for (int k = 0; k < kMaxStepHalvings && value(x + length * direction) > before + 1e-4 * length * fall; ++k)
        length /= 2;
      x += length * direction;
    }
    std::vector<double> weights;
    for (std::size_t i = 0; i < rows_.size(); ++i) weights.push_back(sum_ * part(i, x));
    return weights;
  }

 private:
  double low(std::size_t i) const { return bounds_.lower[i] / sum_; }
  double high(std::size_t i) const { return bounds_.upper[i] / sum_; }
  double free_part(std::size_t i, const Row& x) const { return parts_[i] * (1 + rows_[i].dot(x)); }
  double part(std::size_t i, const Row& x) const { return std::clamp(free_part(i, x), low(i), high(i)); }

  // The wanted sums: 0 for the moments, and 1 for the last entry, since the weights' parts add up to 1.
  static Row wanted() { return Row::Unit(kRows - 1); }
  bool keeps_sum() const { return rows_.front()[kRows - 1] != 0; }

  Row missed(const Row& x) const {
    Row sum = kMissed * x;
    for (std::size_t i = 0; i < rows_.size(); ++i) sum += part(i, x) * rows_[i];
    if (keeps_sum()) sum -= wanted();
    return sum;
  }

  Square jacobian(const Row& x) const {
    Square sum = kMissed * Square::Identity();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double own = free_part(i, x);
      if (own > low(i) && own < high(i)) sum += parts_[i] * rows_[i] * rows_[i].transpose();
    }
    return sum;
  }

  // The function whose gradient is missed(): for each weight, the integral of part() over row . x.
  double value(const Row& x) const {
    double sum = kMissed / 2 * x.squaredNorm();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double along = rows_[i].dot(x), own = part(i, x), bend = own / parts_[i] - 1;
      sum += own * along - parts_[i] * bend * bend / 2;
    }
    return keeps_sum() ? sum - wanted().dot(x) : sum;
  }

  std::vector<Row> rows_;
  const WeightBounds& bounds_;
  std::vector<double> parts_;  // of the wanted weights' sum
  double sum_ = 0;
};

}  // namespace

Eigen::Matrix3d second_moment(const MassProperties& body) {
  return (body.inertia.trace() / 2 * Eigen::Matrix3d::Identity() - body.inertia) / body.volume;
}

MassProperties body_of(std::span<const Sphere> balls, std::span<const double> masses) {
  MassProperties body;
  Vector first = Vector::Zero();
  const Point origin = balls.front().center;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    body.volume += masses[i];
    first += masses[i] * (balls[i].center - origin);
  }
  body.center = origin + first / body.volume;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vector at = balls[i].center - body.center;
    const double own = 0.4 * balls[i].radius * balls[i].radius;
    body.inertia += masses[i] * ((at.squaredNorm() + own) * Eigen::Matrix3d::Identity() - at * at.transpose());
  }
  return body;
}

std::vector<double> weights_with_moments(std::span<const Sphere> balls, const WeightBounds& bounds,
                                         const MassProperties& body, bool keep_sum) {
  return Dual(rows_of(balls, body, keep_sum), bounds).solve();
}

}  // namespace orchard::detail
