#include <algorithm>
#include <cmath>
#include <limits>

#include "support.h"

namespace orchard::runtime::test {
namespace {

using Real = long double;
using Point = std::array<Real, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point plus(const Point& a, const Point& b, Real s) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool separated_along(const Point& axis, const Triangle& a, const Triangle& b) {
  const auto range = [&axis](const Triangle& t) {
    return std::minmax({dot(axis, t[0]), dot(axis, t[1]), dot(axis, t[2])});
  };
  const auto [a_low, a_high] = range(a);
  const auto [b_low, b_high] = range(b);
  return a_high < b_low || b_high < a_low;
}

Real point_segment(const Point& p, const Point& a, const Point& b) {
  const Point ab = minus(b, a);
  const Real square = dot(ab, ab);
  const Real s = square > 0 ? std::clamp<Real>(dot(minus(p, a), ab) / square, 0, 1) : 0;
  return length(minus(p, plus(a, ab, s)));
}

// The minimum lies at an end of one segment, or where the common perpendicular meets the interior of both.
Real segment_segment(const Point& p, const Point& q, const Point& a, const Point& b) {
  Real best =
      std::min({point_segment(p, a, b), point_segment(q, a, b), point_segment(a, p, q), point_segment(b, p, q)});
  const Point u = minus(q, p), v = minus(b, a), w = minus(p, a);
  const Real uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
  const Real determinant = uu * vv - uv * uv;
  if (determinant > 0) {
    const Real s = (uv * dot(v, w) - vv * dot(u, w)) / determinant;
    const Real t = (uu * dot(v, w) - uv * dot(u, w)) / determinant;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, length(minus(plus(p, u, s), plus(a, v, t))));
  }
  return best;
}

struct Ball {
  Point center;
  Real radius;
};

Ball ball_of(const Triangle& t) {
  Point c{};
  for (const Point& p : t) c = plus(c, p, Real(1) / 3);
  return {c, std::max({length(minus(t[0], c)), length(minus(t[1], c)), length(minus(t[2], c))})};
}

std::vector<Ball> balls_of(const std::vector<Triangle>& triangles) {
  std::vector<Ball> balls;
  balls.reserve(triangles.size());
  for (const Triangle& t : triangles) balls.push_back(ball_of(t));
  return balls;
}

}  // namespace

std::vector<Triangle> placed_triangles(const PackedSphereTree& tree, const Pose& pose) {
  std::vector<Triangle> result;
  for (const auto& t : tree.triangles) {
    Triangle placed{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Point body{};
      for (std::size_t i = 0; i < 3; ++i) body[i] = Real(tree.vertices[t[corner]][i]) + Real(tree.origin[i]);
      for (std::size_t i = 0; i < 3; ++i) {
        placed[corner][i] = Real(pose.translation[i]);
        for (std::size_t j = 0; j < 3; ++j)
          placed[corner][i] += Real(pose.scale) * Real(pose.rotation[3 * i + j]) * body[j];
      }
    }
    result.push_back(placed);
  }
  return result;
}

std::vector<Triangle> triangles_below(const PackedSphereTree& tree, std::uint32_t node,
                                      const std::vector<Triangle>& placed) {
  const std::uint32_t child = tree.obb_nodes[node / kBlockWidth].child[node % kBlockWidth];
  std::vector<Triangle> result;
  if (child & kLeafBit) {
    for (const std::uint32_t t : tree.triangle_blocks[child & ~kLeafBit].triangle) {
      if (t != kNoTriangle) result.push_back(placed[t]);
    }
    return result;
  }
  for (std::uint32_t lane = 0; lane < kBlockWidth && tree.obb_nodes[child].radius[lane] >= 0; ++lane) {
    const auto more = triangles_below(tree, child * kBlockWidth + lane, placed);
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

bool triangles_intersect(const Triangle& a, const Triangle& b) {
  std::array<Point, 3> ea{}, eb{};
  for (std::size_t i = 0; i < 3; ++i) {
    ea[i] = minus(a[(i + 1) % 3], a[i]);
    eb[i] = minus(b[(i + 1) % 3], b[i]);
  }
  const Point na = cross(ea[0], ea[1]), nb = cross(eb[0], eb[1]);
  if (separated_along(na, a, b) || separated_along(nb, a, b)) return false;
  const Point offset = minus(b[0], a[0]);  // serves triangles that are segments or points
  if (separated_along(offset, a, b)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const Point& e : {ea[i], eb[i]}) {
      if (separated_along(cross(e, cross(offset, e)), a, b)) return false;
    }
    // In-plane axes serve coplanar triangles; between others they are merely valid.
    if (separated_along(cross(na, ea[i]), a, b) || separated_along(cross(nb, eb[i]), a, b)) return false;
    for (const Point& e : eb) {
      if (separated_along(cross(ea[i], e), a, b)) return false;
    }
  }
  return true;
}

long double point_distance(const std::array<long double, 3>& p, const Triangle& t) {
  Real best = std::min({point_segment(p, t[0], t[1]), point_segment(p, t[1], t[2]), point_segment(p, t[2], t[0])});
  const Point u = minus(t[1], t[0]), v = minus(t[2], t[0]), n = cross(u, v), w = minus(p, t[0]);
  const Real nn = dot(n, n);
  if (nn > 0) {
    const Real s = dot(cross(w, v), n) / nn, r = dot(cross(u, w), n) / nn;
    if (s >= 0 && r >= 0 && s + r <= 1) best = std::min(best, std::fabs(dot(w, n)) / std::sqrt(nn));
  }
  return best;
}

long double triangle_distance(const Triangle& a, const Triangle& b) {
  Real best = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    best = std::min({best, point_distance(a[i], b), point_distance(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j) {
      best = std::min(best, segment_segment(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
  }
  return best > 0 && triangles_intersect(a, b) ? 0 : best;
}

bool surfaces_intersect(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
  const auto balls_a = balls_of(a), balls_b = balls_of(b);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Real gap = length(minus(balls_a[i].center, balls_b[j].center)) - balls_a[i].radius - balls_b[j].radius;
      if (gap <= 1e-9L * (balls_a[i].radius + balls_b[j].radius) && triangles_intersect(a[i], b[j])) return true;
    }
  }
  return false;
}

long double surface_distance(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
  const auto balls_a = balls_of(a), balls_b = balls_of(b);
  Real best = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Real gap = length(minus(balls_a[i].center, balls_b[j].center)) - balls_a[i].radius - balls_b[j].radius;
      if (gap < best) best = std::min(best, triangle_distance(a[i], b[j]));
    }
  }
  return best;
}

}  // namespace orchard::runtime::test
