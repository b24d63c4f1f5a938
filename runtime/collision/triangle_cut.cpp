#include "collision/triangle_cut.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "collision/triangle_distance.h"
#include "math/vector_functions.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kNear = 1e-10;       // of the triangles' size: closer is touching
constexpr double kOn = 1e-12;         // the same, for what is said to be common to both
constexpr double kInclusive = 1e-12;  // of products of two lengths: what counts as on an edge

double square(const Vec3& v) noexcept { return dot(v, v); }

Vec3 unit_or_zero(const Vec3& v) noexcept {
  const double size = std::sqrt(square(v));
  return size > 0 ? along({0, 0, 0}, v, 1 / size) : Vec3{0, 0, 0};
}

// The two of all points offered that are farthest apart, nearly: the farthest from the first, and the farthest from it.
class Ends {
 public:
  void add(const Vec3& p) noexcept {
    if (count_ < points_.size()) points_[count_++] = p;
  }
  std::size_t count() const noexcept { return count_; }
  Segment3 farthest() const noexcept {
    Segment3 best{points_[0], points_[0]};
    double most = -1;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = i; j < count_; ++j) {
        const double apart = square(minus(points_[i], points_[j]));
        if (apart > most) most = apart, best = {points_[i], points_[j]};
      }
    }
    return best;
  }

 private:
  std::array<Vec3, 24> points_{};
  std::size_t count_ = 0;
};

// Beyond a sharp corner a point may be close to the lines of both edges, and far from the triangle.
bool holds(const TrianglePoints& t, const Vec3& p, double slack) noexcept {
  return nearest_points(p, t).distance <= slack;
}

// Where the edges of one cross the plane of the other, in it.
void add_crossings(const TrianglePoints& edges, const TrianglePoints& t, double slack, Ends& ends) noexcept {
  const Vec3 normal = unit_or_zero(cross(minus(t[1], t[0]), minus(t[2], t[0])));
  if (square(normal) == 0) return;
  Vec3 height{};
  for (std::size_t i = 0; i < 3; ++i) height[i] = dot(normal, minus(edges[i], t[0]));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (std::fabs(height[i]) <= slack && holds(t, edges[i], slack)) ends.add(edges[i]);
    if ((height[i] > slack && height[j] < -slack) || (height[i] < -slack && height[j] > slack)) {
      const Vec3 x = along(edges[i], minus(edges[j], edges[i]), height[i] / (height[i] - height[j]));
      if (holds(t, x, slack)) ends.add(x);
    }
  }
}

// Where edges cross or touch edges: for triangles in one plane.
void add_edge_contacts(const TrianglePoints& a, const TrianglePoints& b, double slack, Ends& ends) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 u = minus(a[(i + 1) % 3], a[i]), v = minus(b[(j + 1) % 3], b[j]), w = minus(b[j], a[i]);
      const Vec3 n = cross(u, v);
      if (!(square(n) > kInclusive * square(u) * square(v))) continue;
      const double s = dot(cross(w, v), n) / square(n), t = dot(cross(w, u), n) / square(n);
      if (s < 0 || s > 1 || t < 0 || t > 1) continue;
      const Vec3 p = along(a[i], u, s);
      if (square(minus(p, along(b[j], v, t))) <= slack * slack) ends.add(p);
    }
  }
}

struct Flat {  // a triangle seen along a way
  std::array<double, 3> x, y, z;
};

Flat seen_along(const TrianglePoints& t, const Vec3& origin, const Way& way) noexcept {
  Flat flat{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 p = minus(t[i], origin);
    flat.x[i] = dot(way.e, p), flat.y[i] = dot(way.f, p), flat.z[i] = dot(way.u, p);
  }
  return flat;
}

struct LargestOffer {
  double t = -std::numeric_limits<double>::infinity();
  int kind = 0;  // 1: a corner of b on a; 2: a corner of a on b; 3: two edges
  std::size_t i = 0, j = 0;
  void offer(double value, int what, std::size_t first, std::size_t second) noexcept {
    if (value > t) t = value, kind = what, i = first, j = second;
  }
};

// Calls offer(corner of q, height of p's plane above that corner) for the corners of q that p covers.
template <typename Offer>
void covered_corners(const Flat& p, const Flat& q, Offer&& offer) noexcept {
  const double ux = p.x[1] - p.x[0], uy = p.y[1] - p.y[0], vx = p.x[2] - p.x[0], vy = p.y[2] - p.y[0];
  const double area = ux * vy - uy * vx, size = std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
  if (!(std::fabs(area) > kInclusive * size)) return;
  for (std::size_t k = 0; k < 3; ++k) {
    const double wx = q.x[k] - p.x[0], wy = q.y[k] - p.y[0];
    const double s = (wx * vy - wy * vx) / area, t = (ux * wy - uy * wx) / area;
    if (s < -kInclusive || t < -kInclusive || s + t > 1 + kInclusive) continue;
    offer(k, p.z[0] + s * (p.z[1] - p.z[0]) + t * (p.z[2] - p.z[0]) - q.z[k]);
  }
}

void crossing_edges(const Flat& a, const Flat& b, LargestOffer& best) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i2 = (i + 1) % 3;
    const double ux = a.x[i2] - a.x[i], uy = a.y[i2] - a.y[i];
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j2 = (j + 1) % 3;
      const double vx = b.x[j2] - b.x[j], vy = b.y[j2] - b.y[j], wx = b.x[j] - a.x[i], wy = b.y[j] - a.y[i];
      const double det = ux * vy - uy * vx;
      if (!(std::fabs(det) > kInclusive * std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy)))) continue;
      const double s = (wx * vy - wy * vx) / det, t = (wx * uy - wy * ux) / det;
      if (s < -kInclusive || s > 1 + kInclusive || t < -kInclusive || t > 1 + kInclusive) continue;
      best.offer(a.z[i] + s * (a.z[i2] - a.z[i]) - (b.z[j] + t * (b.z[j2] - b.z[j])), 3, i, j);
    }
  }
}

// Both seen edge on, in one line: where their ends lie on each other's edges.
void ends_on_edges(const Flat& p, const Flat& q, double slack, int kind, LargestOffer& best) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double ux = p.x[j] - p.x[i], uy = p.y[j] - p.y[i], wx = q.x[k] - p.x[i], wy = q.y[k] - p.y[i];
      const double uu = ux * ux + uy * uy;
      const double s = uu > 0 ? std::clamp((wx * ux + wy * uy) / uu, 0.0, 1.0) : 0;
      const double dx = wx - s * ux, dy = wy - s * uy;
      if (dx * dx + dy * dy > slack * slack) continue;
      const double height = p.z[i] + s * (p.z[j] - p.z[i]) - q.z[k];
      best.offer(kind == 1 ? height : -height, kind, k, i);
      if (uu <= slack * slack) best.offer(kind == 1 ? p.z[j] - q.z[k] : q.z[k] - p.z[j], kind, k, i);
    }
  }
}

Vec3 normal_of(const TrianglePoints& t) noexcept { return cross(minus(t[1], t[0]), minus(t[2], t[0])); }

double size_of(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    most = std::max({most, square(minus(a[i], a[0])), square(minus(b[i], b[0]))});
  }
  return std::sqrt(most);
}

}  // namespace

Way::Way(const Vec3& direction) noexcept : u(unit_or_zero(direction)) {
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::fabs(u[i]) < std::fabs(u[least])) least = i;
  }
  Vec3 axis{};
  axis[least] = 1;
  e = unit_or_zero(cross(u, axis));
  f = cross(u, e);
}

Segment3 common_segment(const TrianglePoints& a, const TrianglePoints& b, const Vec3& witness) noexcept {
  const double slack = kOn * size_of(a, b);
  Ends ends;
  add_crossings(a, b, slack, ends);
  add_crossings(b, a, slack, ends);
  if (ends.count() != 2) add_edge_contacts(a, b, slack, ends);
  if (ends.count() == 0) return {witness, witness};
  return ends.farthest();
}

Exit exit_along(const TrianglePoints& a, const TrianglePoints& b, const Way& way) noexcept {
  const Flat p = seen_along(a, a[0], way), q = seen_along(b, a[0], way);
  LargestOffer best;
  covered_corners(p, q, [&best](std::size_t k, double height) { best.offer(height, 1, k, 0); });
  covered_corners(q, p, [&best](std::size_t k, double height) { best.offer(-height, 2, k, 0); });
  crossing_edges(p, q, best);
  if (best.kind == 0) {
    const double slack = kNear * size_of(a, b);
    ends_on_edges(p, q, slack, 1, best);
    ends_on_edges(q, p, slack, 2, best);
  }
  Vec3 normal = way.u;
  if (best.kind == 1) normal = normal_of(a);
  if (best.kind == 2) normal = normal_of(b);
  if (best.kind == 3) {
    normal = cross(minus(a[(best.i + 1) % 3], a[best.i]), minus(b[(best.j + 1) % 3], b[best.j]));
  }
  normal = unit_or_zero(normal);
  if (dot(normal, way.u) < 0) normal = along({0, 0, 0}, normal, -1);
  return {best.t, normal};
}

bool are_parted_by(const TrianglePoints& a, const TrianglePoints& b, double gap) noexcept {
  TrianglePoints p, q, of_a, of_b;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = minus(a[i], a[0]), q[i] = minus(b[i], a[0]);
    of_a[i] = minus(a[(i + 1) % 3], a[i]), of_b[i] = minus(b[(i + 1) % 3], b[i]);
  }
  const auto part = [&](const Vec3& n) {
    const double a0 = dot(n, p[0]), a1 = dot(n, p[1]), a2 = dot(n, p[2]);
    const double b0 = dot(n, q[0]), b1 = dot(n, q[1]), b2 = dot(n, q[2]);
    const double apart =
        std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}), std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
    return apart > 0 && apart * apart > gap * gap * square(n);
  };
  if (part(cross(of_a[0], of_a[1])) || part(cross(of_b[0], of_b[1]))) return true;
  for (const Vec3& u : of_a) {
    for (const Vec3& v : of_b) {
      const Vec3 n = cross(u, v);
      if (square(n) > kInclusive * square(u) * square(v) && part(n)) return true;
    }
  }
  return false;
}

MeetingShifts::MeetingShifts(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  TrianglePoints p, q;  // relative to a corner, so that little is lost far from the origin
  TrianglePoints of_a, of_b;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = minus(a[i], a[0]), q[i] = minus(b[i], a[0]);
    of_a[i] = minus(a[(i + 1) % 3], a[i]), of_b[i] = minus(b[(i + 1) % 3], b[i]);
  }
  const double size = size_of(a, b);
  double least = std::numeric_limits<double>::infinity();
  // Returns false if the set is flat across the normal.
  const auto add = [&](const Vec3& normal, double parallel) {
    const double length = std::sqrt(square(normal));
    if (!(length > parallel)) return true;  // of parallel edges: other planes bound the set
    const Vec3 n = along({0, 0, 0}, normal, 1 / length);
    const double a0 = dot(n, p[0]), a1 = dot(n, p[1]), a2 = dot(n, p[2]);
    const double b0 = dot(n, q[0]), b1 = dot(n, q[1]), b2 = dot(n, q[2]);
    const double ahead = std::max({a0, a1, a2}) - std::min({b0, b1, b2}),
                 behind = std::max({b0, b1, b2}) - std::min({a0, a1, a2});
    normals_[count_] = n, ahead_[count_] = ahead, behind_[count_] = behind;
    ++count_;
    if (ahead < least) least = ahead, shortest_ = along({0, 0, 0}, n, ahead);
    if (behind < least) least = behind, shortest_ = along({0, 0, 0}, n, -behind);
    return ahead + behind > kNear * size;
  };
  bool solid = add(cross(of_a[0], of_a[1]), 0) && add(cross(of_b[0], of_b[1]), 0);
  for (std::size_t i = 0; i < 3 && solid; ++i) {
    for (std::size_t j = 0; j < 3 && solid; ++j) {
      solid = add(cross(of_a[i], of_b[j]), kNear * std::sqrt(square(of_a[i]) * square(of_b[j])));
    }
  }
  if (solid && count_ > 0) {
    least_ = least;
  } else {
    count_ = 0, shortest_ = {};
  }
}

bool MeetingShifts::contain(const Vec3& direction, double t) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const double height = t * dot(normals_[i], direction);
    if (height > ahead_[i] || -height > behind_[i]) return false;
  }
  return count_ > 0;
}

}  // namespace orchard::runtime::detail
