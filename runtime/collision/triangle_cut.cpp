#include "collision/triangle_cut.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "collision/triangle_distance.h"
#include "math/vector_functions.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kNear = 1e-10;       // of the triangles' size: a set of shifts that is thinner is flat
constexpr double kOn = 1e-12;         // of the triangles' size: the tolerance for common points
constexpr double kInclusive = 1e-12;  // the square of the sine of edges that count as parallel
constexpr double kSliding = 1e-12;    // the cosine of a direction that counts as along a plane
constexpr double kParallel = 1e-24;   // the square of the sine of edges that give no plane of MeetingShifts
constexpr double kShift = 1e-13;      // of the triangles' size: the rounding error of shifts

double square(const Vec3& v) noexcept { return dot(v, v); }

// Collects points and finds the two that are farthest apart.
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

// Returns whether a point of the triangle's plane is no farther than `slack` from the triangle. Beyond a sharp corner,
// a point may be close to the lines of both edges and far from the triangle, so the distance decides.
bool holds(const TrianglePoints& t, const Vec3& normal, const Vec3& p, double slack, double size) noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, dot(cross(normal, minus(t[(i + 1) % 3], t[i])), minus(p, t[i])));
  }
  if (least >= 0) return true;
  return least >= -slack * size && nearest_points(p, p, t).distance <= slack;
}

// Adds the points in which the edges of one triangle cross or touch the plane of the other one, if they are in the
// other one.
void add_crossings(const TrianglePoints& edges, const TrianglePoints& t, const Vec3& normal, double size,
                   Ends& ends) noexcept {
  const double slack = kOn * size;
  if (square(normal) == 0) return;
  Vec3 height{};
  for (std::size_t i = 0; i < 3; ++i) height[i] = dot(normal, minus(edges[i], t[0]));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (std::fabs(height[i]) <= slack && holds(t, normal, edges[i], slack, size)) ends.add(edges[i]);
    if ((height[i] > slack && height[j] < -slack) || (height[i] < -slack && height[j] > slack)) {
      const Vec3 x = along(edges[i], minus(edges[j], edges[i]), height[i] / (height[i] - height[j]));
      if (holds(t, normal, x, slack, size)) ends.add(x);
    }
  }
}

// Adds the points in which edges cross or touch edges; for triangles in one plane.
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

std::array<Vec3, 3> sides_of(const TrianglePoints& t) noexcept {
  return {minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
}

Vec3 normal_of(const TrianglePoints& t) noexcept { return cross(minus(t[1], t[0]), minus(t[2], t[0])); }

double size_of(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) most = std::max({most, square(minus(a[i], a[0])), square(minus(b[i], b[0]))});
  return std::sqrt(most);
}

// Two triangles relative to a corner of the first one, so that little is lost to rounding far from the origin.
struct NearPair {
  Vec3 a1, a2, b0, b1, b2;
  NearPair(const TrianglePoints& a, const TrianglePoints& b) noexcept
      : a1(minus(a[1], a[0])),
        a2(minus(a[2], a[0])),
        b0(minus(b[0], a[0])),
        b1(minus(b[1], a[0])),
        b2(minus(b[2], a[0])) {}

  ShiftPlanes across(const Vec3& n) const noexcept {
    const double p1 = dot(n, a1), p2 = dot(n, a2), q0 = dot(n, b0), q1 = dot(n, b1), q2 = dot(n, b2);
    return {n, max(max(0, p1), p2) - min(min(q0, q1), q2), max(max(q0, q1), q2) - min(min(0, p1), p2)};
  }
};

}  // namespace

Way::Way(const Vec3& direction) noexcept : u(unit_or_zero(direction)) {
  e = unit_or_zero(cross(u, least_axis(u)));
  f = cross(u, e);
}

Segment3 common_segment(const TrianglePoints& a, const TrianglePoints& b, const std::array<ShiftPlanes, 2>& faces,
                        const Vec3& witness) noexcept {
  const double size = size_of(a, b);
  Ends ends;
  add_crossings(a, b, faces[1].normal, size, ends);
  add_crossings(b, a, faces[0].normal, size, ends);
  if (ends.count() != 2) add_edge_contacts(a, b, kOn * size, ends);
  if (ends.count() == 0) return {witness, witness};
  return ends.farthest();
}

bool are_parted_by(const TrianglePoints& a, const TrianglePoints& b, double gap) noexcept {
  const NearPair pair(a, b);
  const auto part = [&](const Vec3& n) {
    const ShiftPlanes planes = pair.across(n);
    const double apart = max(-planes.ahead, -planes.behind);
    return apart > 0 && apart * apart > gap * gap * square(n);
  };
  const std::array<Vec3, 3> of_a = sides_of(a), of_b = sides_of(b);
  if (part(cross(of_a[0], of_a[1])) || part(cross(of_b[0], of_b[1]))) return true;
  for (const Vec3& u : of_a) {
    for (const Vec3& v : of_b) {
      const Vec3 n = cross(u, v);
      if (square(n) > kInclusive * square(u) * square(v) && part(n)) return true;
    }
  }
  return false;
}

double ShiftPlanes::exit(const Vec3& direction, double slack) const noexcept {
  // Along the planes of faces that slide on each other, the result would be nothing but rounding, so such planes end no
  // shift.
  const double along = dot(normal, direction);
  if (!(std::fabs(along) > kSliding)) return std::numeric_limits<double>::infinity();
  return ((along > 0 ? ahead : behind) + slack) / std::fabs(along);
}

std::array<ShiftPlanes, 2> face_planes(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  const NearPair pair(a, b);
  return {pair.across(unit_or_zero(normal_of(a))), pair.across(unit_or_zero(normal_of(b)))};
}

MeetingShifts::MeetingShifts(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  const NearPair pair(a, b);
  const auto add = [&](const Vec3& normal, double parallel) {
    const double square_of_normal = square(normal);
    if (!(square_of_normal > parallel)) return;
    planes_[count_++] = pair.across((1 / std::sqrt(square_of_normal)) * normal);
  };
  const std::array<Vec3, 3> of_a = sides_of(a), of_b = sides_of(b);
  add(cross(of_a[0], of_a[1]), 0), add(cross(of_b[0], of_b[1]), 0);
  for (const Vec3& u : of_a) {
    for (const Vec3& v : of_b) add(cross(u, v), kParallel * square(u) * square(v));  // other planes bound the set there
  }
  const double size = size_of(a, b);
  slack_ = kShift * size;
  const auto* const flat = std::find_if(planes_.begin(), planes_.begin() + static_cast<std::ptrdiff_t>(count_),
                                        [&](const ShiftPlanes& p) { return !(p.ahead + p.behind > kNear * size); });
  flat_ = count_ == 0 || flat != planes_.begin() + static_cast<std::ptrdiff_t>(count_);
  if (count_ == 0 || !flat_) return;
  const Vec3 normal = flat->normal;  // the plane of the flat set; the planes that are added below bound a polygon in it
  count_ = 0;
  add(normal, 0);
  for (const std::array<Vec3, 3>& edges : {of_a, of_b}) {
    for (const Vec3& edge : edges) add(cross(normal, edge), 0);
  }
}

MeetingShifts::Exit MeetingShifts::exit(const Vec3& direction, double least) const noexcept {
  Exit first{count_ > 0 ? std::numeric_limits<double>::infinity() : 0, direction};
  for (std::size_t i = 0; i < count_ && first.way > least; ++i) {
    const double way = planes_[i].exit(direction, slack_);
    if (way < first.way) first = {way, planes_[i].normal};
  }
  if (dot(first.normal, direction) < 0) first.normal = -first.normal;
  return first;
}

bool MeetingShifts::contain(const Vec3& direction, double t) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const double height = t * dot(planes_[i].normal, direction);
    if (height > planes_[i].ahead || -height > planes_[i].behind) return false;
  }
  return !flat_;
}

Vec3 MeetingShifts::shortest_way_out() const noexcept {
  Vec3 shortest{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_ && !flat_; ++i) {
    const auto& [normal, ahead, behind] = planes_[i];
    if (ahead < least) least = ahead, shortest = ahead * normal;
    if (behind < least) least = behind, shortest = -behind * normal;
  }
  return shortest;
}

double MeetingShifts::shortest() const noexcept { return length(shortest_way_out()); }

}  // namespace orchard::runtime::detail
