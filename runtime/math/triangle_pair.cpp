#include "math/triangle_pair.h"

#include <algorithm>
#include <cmath>

#include "math/vector_functions.h"

// Two closed triangles meet iff an edge of one meets the other one: their common part is convex, and each of its
// extreme points lies on an edge of one of them, because interior points of both can be moved both ways along the
// common line or plane. A triangle of zero area is the union of its edges. So tests of segments against triangles and
// against segments are enough.
namespace orchard::runtime::detail {
namespace {

Vec3 between(const Vec3& a, const Vec3& b, double t) noexcept { return along(a, minus(b, a), t); }
double ratio(double part, double whole) noexcept { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

// ---- Witnesses. These are used only after the exact tests have answered yes.

// Returns the point in which a segment crosses the plane of a triangle. The heights are those of volume(): in planes
// that are nearly the same, plain heights would be nothing but rounding, and so would the point.
Vec3 crossing_point(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  const double hp = std::fabs(volume(t[0], t[1], t[2], p)), hq = std::fabs(volume(t[0], t[1], t[2], q));
  return between(p, q, ratio(hp, hp + hq));
}

Vec3 closest_on_segment(const Vec3& point, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 ab = minus(b, a);
  return between(a, b, ratio(dot(minus(point, a), ab), dot(ab, ab)));
}

// Returns the point of pq closest to ab, for segments that meet. It is at an end of one of them, or where their lines
// cross.
Vec3 meeting_point(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 u = minus(q, p), v = minus(b, a), w = minus(a, p), n = cross(u, v);
  const Vec3 candidates[] = {p, q, closest_on_segment(a, p, q), closest_on_segment(b, p, q),
                             between(p, q, ratio(dot(cross(w, v), n), dot(n, n)))};
  const auto distance = [&a, &b](const Vec3& x) {
    const Vec3 d = minus(x, closest_on_segment(x, a, b));
    return dot(d, d);
  };
  return *std::min_element(std::begin(candidates), std::end(candidates),
                           [&distance](const Vec3& x, const Vec3& y) { return distance(x) < distance(y); });
}

// ---- Exact tests.

bool boxes_overlap(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, std::size_t i) noexcept {
  return std::max(p[i], q[i]) >= std::min(a[i], b[i]) && std::max(a[i], b[i]) >= std::min(p[i], q[i]);
}

// Returns whether two segments meet in the plane that remains when `axis` is dropped.
bool segments_meet_2d(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, std::size_t axis) noexcept {
  if (!boxes_overlap(p, q, a, b, (axis + 1) % 3) || !boxes_overlap(p, q, a, b, (axis + 2) % 3)) return false;
  // If the boxes overlap, this is also right for collinear segments and for points, which meet if their boxes do.
  return orientation(p, q, a, axis) * orientation(p, q, b, axis) <= 0 &&
         orientation(a, b, p, axis) * orientation(a, b, q, axis) <= 0;
}

// Returns whether two segments in space meet. If the four points lie in one plane, a projection along an axis keeps
// what meets, and at least one axis does not flatten that plane. If they lie on one line, their boxes decide. So the
// segments meet iff all projections do.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) noexcept {
  if (orientation(p, q, a, b) != 0) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!segments_meet_2d(p, q, a, b, axis)) return false;
  }
  return true;
}

bool holds_2d(const TrianglePoints& t, const Vec3& p, std::size_t axis) noexcept {
  const int turn = orientation(t[0], t[1], t[2], axis);
  if (turn == 0) return false;  // flattened to a segment: its edges are all of it
  return turn * orientation(t[0], t[1], p, axis) >= 0 && turn * orientation(t[1], t[2], p, axis) >= 0 &&
         turn * orientation(t[2], t[0], p, axis) >= 0;
}

// Returns whether a segment meets a triangle in whose plane it lies. The triangle is not degenerate.
bool coplanar_meet(const Vec3& p, const Vec3& q, const TrianglePoints& t, Vec3* witness) noexcept {
  std::size_t axis = 0;
  while (axis < 2 && orientation(t[0], t[1], t[2], axis) == 0) ++axis;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = t[i], &b = t[(i + 1) % 3];
    if (!segments_meet_2d(p, q, a, b, axis)) continue;
    if (witness) *witness = meeting_point(p, q, a, b);
    return true;
  }
  if (!holds_2d(t, p, axis)) return false;
  if (witness) *witness = p;
  return true;
}

// Returns whether an edge meets `t`, which is not degenerate. `side_p` and `side_q` are the sides of its plane on which
// the ends of the edge lie.
bool edge_meets(const Vec3& p, const Vec3& q, int side_p, int side_q, const TrianglePoints& t, Vec3* witness) noexcept {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_meet(p, q, t, witness);
  const int first = orientation(p, q, t[0], t[1]), second = orientation(p, q, t[1], t[2]);
  if (first * second < 0) return false;
  const int third = orientation(p, q, t[2], t[0]);
  if (first * third < 0 || second * third < 0) return false;
  if (witness) *witness = crossing_point(p, q, t);
  return true;
}

using Sides = std::array<int, 3>;

Sides sides(const TrianglePoints& plane, const TrianglePoints& of) noexcept {
  const PlaneOrientation side(plane);
  return {side(of[0]), side(of[1]), side(of[2])};
}

bool on_one_side(const Sides& s) noexcept { return s[0] * s[1] > 0 && s[0] * s[2] > 0; }
bool in_plane(const Sides& s) noexcept { return s[0] == 0 && s[1] == 0 && s[2] == 0; }

bool edges_meet(const TrianglePoints& edges, const Sides& s, const TrianglePoints& t, Vec3* witness) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (edge_meets(edges[i], edges[j], s[i], s[j], t, witness)) return true;
  }
  return false;
}

bool segments_of_both_meet(const TrianglePoints& a, const TrianglePoints& b, Vec3* witness) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 &p = a[i], &q = a[(i + 1) % 3], &r = b[j], &s = b[(j + 1) % 3];
      if (!segments_meet(p, q, r, s)) continue;
      if (witness) *witness = meeting_point(p, q, r, s);
      return true;
    }
  }
  return false;
}

}  // namespace

bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b, Vec3* witness) noexcept {
  const Sides b_sides = sides(a, b);
  if (on_one_side(b_sides)) return false;
  const Sides a_sides = sides(b, a);
  if (on_one_side(a_sides)) return false;
  // Sides other than 0 exist only if the triangle has a plane, so in_line() is needed only if all are 0.
  const bool a_flat = in_plane(b_sides) && in_line(a[0], a[1], a[2]),
             b_flat = in_plane(a_sides) && in_line(b[0], b[1], b[2]);
  if (a_flat && b_flat) return segments_of_both_meet(a, b, witness);
  return (!a_flat && edges_meet(b, b_sides, a, witness)) || (!b_flat && edges_meet(a, a_sides, b, witness));
}

}  // namespace orchard::runtime::detail
