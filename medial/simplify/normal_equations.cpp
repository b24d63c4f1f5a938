#include "normal_equations.h"

#include <Eigen/LU>
#include <algorithm>

namespace orchard::detail {
namespace {

constexpr int kMaxGradientSteps = 60;  // of conjugate gradients: what remains is left to the next step of the fit
constexpr double kSmall = 1e-4;        // of the first residual: smaller ones end the steps

}  // namespace

NormalEquations::NormalEquations(const ContractibleMesh& mesh) : number_(mesh.size(), kNone) {
  for (Index v = 0; v < mesh.size(); ++v) {
    if (!mesh.alive(v)) continue;
    number_[v] = static_cast<Index>(vertices_.size());
    vertices_.push_back(v);
  }
  offsets_.push_back(0);
  for (const Index v : vertices_) {
    columns_.push_back(number_[v]);
    for (const Index other : mesh.neighbors(v)) columns_.push_back(number_[other]);
    std::sort(columns_.begin() + offsets_.back(), columns_.end());
    offsets_.push_back(static_cast<Index>(columns_.size()));
  }
  clear();
}

void NormalEquations::clear() {
  blocks_.assign(columns_.size(), Eigen::Matrix4d::Zero());
  side_.assign(vertices_.size(), Ball4::Zero());
  vector_.assign(vertices_.size(), Ball4::Zero());
  factor_ = 0;
}

void NormalEquations::add_to_vector(const std::array<Index, 3>& corners, const std::array<double, 3>& weights,
                                    const Ball4& part) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (weights[i] != 0) vector_[number_[corners[i]]] += weights[i] * part;
  }
}

void NormalEquations::add_square(double factor, double value) {
  factor_ = factor;
  for (std::size_t i = 0; i < side_.size(); ++i) side_[i] += factor * value * vector_[i];
}

Index NormalEquations::entry(Index row, Index column) const {
  const auto begin = columns_.begin() + offsets_[row], end = columns_.begin() + offsets_[row + 1];
  return static_cast<Index>(std::lower_bound(begin, end, column) - columns_.begin());
}

void NormalEquations::add(const std::array<Index, 3>& corners, const std::array<double, 3>& weights,
                          const Eigen::Matrix4d& block, const Eigen::Vector4d& side) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (weights[i] == 0) continue;
    const Index row = number_[corners[i]];
    side_[row] += weights[i] * side;
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] != 0) blocks_[entry(row, number_[corners[k]])] += (weights[i] * weights[k]) * block;
    }
  }
}

std::vector<Ball4> NormalEquations::solve(double damping, const std::vector<std::uint8_t>& radius_held) const {
  const std::size_t count = vertices_.size();
  using Balls = std::vector<Ball4>;
  std::vector<Eigen::Matrix4d> inverse(count);
  Balls added(count), x(count, Ball4::Zero()), residual(side_), direction(count), image(count);
  double mean = 0;
  for (Index i = 0; i < count; ++i) mean += blocks_[entry(i, i)].trace() / (4.0 * static_cast<double>(count));
  const auto hold = [&](Balls& balls) {
    for (Index i = 0; i < count; ++i) {
      if (radius_held[vertices_[i]]) balls[i][3] = 0;
    }
  };
  for (Index i = 0; i < count; ++i) {
    const Eigen::Matrix4d& block = blocks_[entry(i, i)];
    added[i] = damping * (block.diagonal() + Ball4::Constant(mean));
    inverse[i] = (block + Eigen::Matrix4d(added[i].asDiagonal())).inverse();
  }
  const auto dot = [&](const Balls& a, const Balls& b) {
    double sum = 0;
    for (Index i = 0; i < count; ++i) sum += a[i].dot(b[i]);
    return sum;
  };
  hold(residual);
  Balls preconditioned(count);
  const auto precondition = [&] {
    for (Index i = 0; i < count; ++i) preconditioned[i] = inverse[i] * residual[i];
    hold(preconditioned);
  };
  precondition();
  direction = preconditioned;
  double product = dot(residual, preconditioned);
  const double first = product;
  for (int step = 0; step < kMaxGradientSteps && product > kSmall * kSmall * first && product > 0; ++step) {
    const double along = factor_ > 0 ? factor_ * dot(vector_, direction) : 0;
    for (Index i = 0; i < count; ++i) {
      Ball4 sum = added[i].cwiseProduct(direction[i]) + along * vector_[i];
      for (Index k = offsets_[i]; k < offsets_[i + 1]; ++k) sum += blocks_[k] * direction[columns_[k]];
      image[i] = sum;
    }
    hold(image);
    const double curvature = dot(direction, image);
    if (!(curvature > 0)) break;
    const double length = product / curvature;
    for (Index i = 0; i < count; ++i) {
      x[i] += length * direction[i];
      residual[i] -= length * image[i];
    }
    precondition();
    const double next = dot(residual, preconditioned);
    for (Index i = 0; i < count; ++i) direction[i] = preconditioned[i] + next / product * direction[i];
    product = next;
  }
  std::vector<Ball4> step(number_.size(), Ball4::Zero());
  for (Index i = 0; i < count; ++i) step[vertices_[i]] = x[i];
  return step;
}

}  // namespace orchard::detail
