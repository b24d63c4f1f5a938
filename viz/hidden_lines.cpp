#include "hidden_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace orchard::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSphereSlack = 0.002;  // of the radius: lines nearer than this to a sphere are not hidden by it
constexpr int kMostCells = 1024;        // along each side
constexpr int kMostPieces = 4096;       // of a segment

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Limits [begin, end] to the part where from + t (to - from) >= 0. Returns whether anything is left.
bool cut(double from, double to, double& begin, double& end) {
  if (from == to) return from >= 0;
  const double zero = from / (from - to);
  if (to > from)
    begin = std::max(begin, zero);
  else
    end = std::min(end, zero);
  return begin < end;
}

// Returns the range of t with |p + t d| < radius.
std::optional<std::pair<double, double>> inside(double dd, double pd, double pp, double radius) {
  if (dd == 0) return pp < radius * radius ? std::optional(std::pair(0.0, 1.0)) : std::nullopt;
  const double root = pd * pd - dd * (pp - radius * radius);
  if (root <= 0) return std::nullopt;
  const double half = std::sqrt(root);
  return std::pair((-pd - half) / dd, (-pd + half) / dd);
}

}  // namespace

void Occluders::add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double area = cross((b - a).head<2>(), (c - a).head<2>());
  if (area == 0) return;  // the triangle is seen edge-on
  if (area > 0)
    triangles_.push_back({a, b, c});
  else
    triangles_.push_back({a, c, b});
}

void Occluders::add_sphere(const Vector3d& center, double radius) {
  if (radius > 0) spheres_.push_back({center, radius});
}

Occluders::Box Occluders::cells_of(const Vector2d& low, const Vector2d& high) const {
  const auto cell = [&](double place, int count) {
    return static_cast<int>(std::clamp(std::floor(place / cell_), 0.0, static_cast<double>(count - 1)));
  };
  return {cell(low.x() - low_.x(), columns_), cell(low.y() - low_.y(), rows_), cell(high.x() - low_.x(), columns_),
          cell(high.y() - low_.y(), rows_)};
}

void Occluders::finish() {
  std::vector<std::pair<Vector2d, Vector2d>> boxes;
  for (const auto& [a, b, c] : triangles_)
    boxes.emplace_back(a.cwiseMin(b).cwiseMin(c).head<2>(), a.cwiseMax(b).cwiseMax(c).head<2>());
  for (const Sphere& sphere : spheres_)
    boxes.emplace_back(sphere.center.head<2>() - Vector2d::Constant(sphere.radius),
                       sphere.center.head<2>() + Vector2d::Constant(sphere.radius));
  if (boxes.empty()) return;
  Eigen::AlignedBox2d all;
  for (const auto& [low, high] : boxes) all.extend(low), all.extend(high);
  low_ = all.min();
  const double side = std::clamp(std::sqrt(static_cast<double>(boxes.size())), 1.0, static_cast<double>(kMostCells));
  cell_ = std::max(all.sizes().maxCoeff() / side, std::numeric_limits<double>::min());
  columns_ = static_cast<int>(all.sizes().x() / cell_) + 1;
  rows_ = static_cast<int>(all.sizes().y() / cell_) + 1;
  sort(boxes);
}

void Occluders::sort(const std::vector<std::pair<Vector2d, Vector2d>>& boxes) {
  const auto visit = [&](const auto& put) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto [x0, y0, x1, y1] = cells_of(boxes[i].first, boxes[i].second);
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) put(cell_at(x, y), static_cast<int>(i));
    }
  };
  begin_.assign(cell_at(0, rows_) + 1, 0);
  visit([&](std::size_t cell, int) { ++begin_[cell + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  sorted_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  visit([&](std::size_t cell, int i) { sorted_[static_cast<std::size_t>(next[cell]++)] = i; });
}

void Occluders::hide_by(int occluder, const Vector3d& a, const Vector3d& b, Hidden& hidden) const {
  const auto number = static_cast<std::size_t>(occluder);
  if (number < triangles_.size())
    hide_by(triangles_[number], a, b, hidden);
  else
    hide_by(spheres_[number - triangles_.size()], a, b, hidden);
}

void Occluders::hide_by(const std::array<Vector3d, 3>& triangle, const Vector3d& a, const Vector3d& b,
                        Hidden& hidden) const {
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector2d from = triangle[i].head<2>(), side = triangle[(i + 1) % 3].head<2>() - from;
    if (!cut(cross(side, a.head<2>() - from), cross(side, b.head<2>() - from), begin, end)) return;
  }
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);  // z > 0
  // Returns how far the triangle is in front of the line, minus the slack.
  const auto before = [&](const Vector3d& p) { return normal.dot(triangle[0] - p) / normal.z() - slack_; };
  if (cut(before(a), before(b), begin, end)) hidden.emplace_back(begin, end);
}

// A sphere hides what is inside it, and what is behind its middle within its outline.
void Occluders::hide_by(const Sphere& sphere, const Vector3d& a, const Vector3d& b, Hidden& hidden) {
  const double radius = (1 - kSphereSlack) * sphere.radius;
  const Vector3d p = a - sphere.center, d = b - a;
  const Vector2d p2 = p.head<2>(), d2 = d.head<2>();
  if (const auto ball = inside(d.squaredNorm(), p.dot(d), p.squaredNorm(), radius)) {
    const double begin = std::max(0.0, ball->first), end = std::min(1.0, ball->second);
    if (begin < end) hidden.emplace_back(begin, end);
  }
  if (const auto disk = inside(d2.squaredNorm(), p2.dot(d2), p2.squaredNorm(), radius)) {
    double begin = std::max(0.0, disk->first), end = std::min(1.0, disk->second);
    if (begin < end && cut(-p.z(), -(p.z() + d.z()), begin, end)) hidden.emplace_back(begin, end);
  }
}

std::vector<std::pair<double, double>> Occluders::visible(const Vector3d& a, const Vector3d& b) const {
  if (columns_ == 0) return {{0, 1}};
  Hidden hidden;
  const double pieces = std::ceil((b - a).head<2>().norm() / cell_);
  const int count = static_cast<int>(std::clamp(pieces, 1.0, static_cast<double>(kMostPieces)));
  std::vector<int> near;
  for (int i = 0; i < count; ++i) {
    const Vector2d from = (a + (b - a) * i / count).head<2>(), to = (a + (b - a) * (i + 1) / count).head<2>();
    const auto [x0, y0, x1, y1] = cells_of(from.cwiseMin(to), from.cwiseMax(to));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto cell = cell_at(x, y);
        near.insert(near.end(), sorted_.begin() + begin_[cell], sorted_.begin() + begin_[cell + 1]);
      }
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const int occluder : near) hide_by(occluder, a, b, hidden);
  std::sort(hidden.begin(), hidden.end());
  std::vector<std::pair<double, double>> seen;
  double at = 0;
  for (const auto& [begin, end] : hidden) {
    if (begin > at) seen.emplace_back(at, begin);
    at = std::max(at, end);
  }
  if (at < 1) seen.emplace_back(at, 1);
  return seen;
}

}  // namespace orchard::detail
