#include "sweep.h"

#include <algorithm>

namespace orchard::runtime::detail {
namespace {

constexpr int kMaxDistanceQueries = 512;  // at a pair's distance, in a sweep
constexpr double kCloseness = 1e-5;       // of the smaller part's size: nearer than that, time passes in steps of it

Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The rotation by `angle` about the unit axis, after `from`.
std::array<double, 9> turned(const std::array<double, 9>& from, const Vec3& axis, double angle) noexcept {
  const double s = std::sin(angle), c = std::cos(angle);
  std::array<double, 9> result{};
  for (std::size_t column = 0; column < 3; ++column) {
    const Vec3 v = {from[column], from[3 + column], from[6 + column]};
    const Vec3 w = c * v + s * cross(axis, v) + ((1 - c) * dot(axis, v)) * axis;
    for (std::size_t row = 0; row < 3; ++row) result[3 * row + column] = w[row];
  }
  return result;
}

}  // namespace

PoseWay::PoseWay(const PlacedPart& from, const PlacedPart& to) noexcept : from_(from.pose), to_(to.pose) {
  center_ = from.shape->center;
  begin_ = transform(from_, center_);
  way_ = Vec3(transform(to_, center_)) - begin_;
  // r = to * from^T, whose axis is its skew part's, or for half a turn its symmetric part's.
  std::array<double, 9> r{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) r[3 * i + j] += to_.rotation[3 * i + k] * from_.rotation[3 * j + k];
    }
  }
  const Vec3 skew = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
  const double sine = 0.5 * length(skew), cosine = 0.5 * (r[0] + r[4] + r[8] - 1);
  angle_ = std::atan2(sine, cosine);
  if (sine > 1e-8) {
    axis_ = (0.5 / sine) * skew;
    axis_ = (1 / length(axis_)) * axis_;
  } else if (cosine < 0) {
    std::size_t largest = 0;
    for (std::size_t i = 1; i < 3; ++i) largest = r[4 * i] > r[4 * largest] ? i : largest;
    for (std::size_t i = 0; i < 3; ++i) axis_[i] = r[3 * largest + i] + (i == largest ? 1 : 0);
    axis_ = (1 / length(axis_)) * axis_;
  } else {
    angle_ = sine;  // too small for its axis to matter: the ends differ by less than 1e-8 of the size
    axis_ = sine > 0 ? (0.5 / sine) * skew : Vec3{0, 0, 1};
  }
  speed_ = (length(way_) + angle_ * from.reach) * (1 + 1e-9);
}

Pose PoseWay::at(double time) const noexcept {
  if (time <= 0) return from_;
  if (time >= 1) return to_;
  Pose pose = from_;
  pose.rotation = turned(from_.rotation, axis_, time * angle_);
  const auto arm = rotate(pose, center_);
  for (std::size_t i = 0; i < 3; ++i) pose.translation[i] = begin_[i] + time * way_[i] - pose.scale * arm[i];
  return is_rigid(pose) ? pose : made_rigid(pose).value_or(from_);
}

Swept sweep(NarrowPhase& narrow, DistanceQuery& distance, const PlacedPair& from, const PlacedPair& to,
            std::uint64_t most, std::uint64_t& work) noexcept {
  Swept result;
  const bool half = from.b.shape == nullptr;
  if (!is_rigid(from.a.pose) || !is_rigid(to.a.pose) || (!half && (!is_rigid(from.b.pose) || !is_rigid(to.b.pose)))) {
    result.answer = Answer::maybe;
    return result;
  }
  const PoseWay a(from.a, to.a), b(half ? from.a : from.b, half ? from.a : to.b);
  const double speed = a.speed() + b.speed();
  const double near = kCloseness * (half ? from.a.reach : std::min(from.a.reach, from.b.reach));
  if (!(speed > 0)) return result;
  PlacedPair now = from;
  const auto apart = [&]() -> double {
    if (half) return work += kSimplePairWork, half_space_distance(*now.a.shape, now.a.pose, now.half);
    if (now.simple()) {
      work += kSimplePairWork;
      return simple_distance(*now.a.shape, now.a.pose, *now.b.shape, now.b.pose);
    }
    distance.bind(now.a.shape->prepared, now.b.shape->prepared);
    distance.start(now.a.pose, now.b.pose, {.relative = 0.1, .absolute = near});
    distance.refine({.pair_tests = most - work});
    work += distance.work();
    return distance.lower();
  };
  double time = 0;
  bool certain = true;
  for (int query = 0; query < kMaxDistanceQueries && work < most; ++query) {
    now.a.pose = a.at(time);
    if (!half) now.b.pose = b.at(time);
    const double gap = apart();
    if (gap <= near && work < most) {
      const Verdict verdict = answer_exactly(narrow, now, work, most);
      if (verdict.answer == Answer::yes) {
        if (certain) result.from = time;
        result.answer = Answer::yes;
        result.to = time;
        result.verdict = verdict;
        return result;
      }
    }
    if (time >= 1) {
      result.answer = certain ? Answer::no : Answer::maybe;
      return result;
    }
    if (gap < near && certain) {
      certain = false;
      result.from = time;
    }
    time = std::min(1.0, time + std::max(gap, near) / speed);
  }
  if (certain) result.from = time;
  result.answer = Answer::maybe;
  return result;
}

}  // namespace orchard::runtime::detail
