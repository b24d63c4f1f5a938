#include "collision/segment_meets.h"

#include <cmath>

#include "math/vector_functions.h"

namespace orchard::runtime::detail {
namespace {

// The error of the plain evaluation below. Differences of the coordinates are right to u = 2^-53 of themselves. Let a,
// b, c be the largest components of three such vectors. A component of the product of the first two is at most 2 a b
// and off by less than 8 u a b, so a triple product is off by less than 3 (8 u + 4 * 2 u) a b c = 48 u a b c, if
// nothing underflows or overflows on the way. This holds if a b and a b c are between kLeast and 1 / kLeast: what
// underflows is below 2^-1074 of a term that then is less than 2^-53 u of a b.
constexpr double kPlainError = 64 * 0x1p-53;
constexpr double kLeast = 0x1p-900;

bool within_range(double ab, double abc) noexcept { return min(ab, abc) > kLeast && max(ab, abc) < 1 / kLeast; }

// If the sum of two heights is larger than this part of a b c, it determines a place on the segment to 2^-40 of its
// length.
constexpr double kTells = kPlainError * 0x1p40;

// The heights of a segment's ends over a triangle's plane, times twice the triangle's area. `clear` means that their
// signs are certain, and `tell` that they also determine where the segment passes through the plane.
struct Heights {
  double from, to;
  bool clear, tell;
  Heights(const Vec3& begin, const Vec3& end, const TrianglePoints& t) noexcept {
    const Vec3 edge = minus(t[1], t[0]), other = minus(t[2], t[0]), normal = cross(edge, other);
    const Vec3 back = minus(begin, t[0]), ahead = minus(end, t[0]);
    from = dot(normal, back), to = dot(normal, ahead);
    const double ab = max_abs(edge) * max_abs(other), abc = ab * max(max_abs(back), max_abs(ahead));
    const bool certain = min(std::fabs(from), std::fabs(to)) > kPlainError * abc, ordinary = within_range(ab, abc);
    clear = certain & ordinary;
    tell = clear & (std::fabs(from) + std::fabs(to) > kTells * abc);
  }
  bool differ() const noexcept { return (from > 0) != (to > 0); }
};

Vec3 crossing(const Vec3& from, const Vec3& way, double height_from, double height_to) noexcept {
  const double hp = std::fabs(height_from), hq = std::fabs(height_to);
  return along(from, way, hp + hq > 0 ? min(hp / (hp + hq), 1) : 0);
}

Vec3 crossing_exactly(const Vec3& from, const Vec3& to, const TrianglePoints& t) noexcept {
  return crossing(from, minus(to, from), volume(t[0], t[1], t[2], from), volume(t[0], t[1], t[2], to));
}

// Returns the first point of a segment that it shares with a triangle, for a segment in the triangle's plane, or a
// triangle without area. It is the segment's begin or a point in which the segment meets the boundary; if the segment
// runs along an edge, a corner. It is correct up to rounding. `any` is a common point.
Vec3 first_common(const Vec3& from, const Vec3& to, const TrianglePoints& t, const Vec3& any) noexcept {
  if (triangles_intersect({from, from, from}, t, nullptr)) return from;
  const TrianglePoints segment = {from, to, to};
  const Vec3 way = minus(to, from);
  Vec3 first = any;
  const auto offer = [&](const Vec3& point) {
    if (dot(minus(point, from), way) < dot(minus(first, from), way)) first = point;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = t[i], &b = t[(i + 1) % 3];
    Vec3 common{};
    if (triangles_intersect(segment, {a, b, b}, &common)) offer(common);
    if (triangles_intersect(segment, {a, a, a}, nullptr)) offer(a);
  }
  return first;
}

// Does the same as segment_meets(), with exact signs only.
bool meets_exactly(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept {
  if (!triangles_intersect({from, to, to}, t, &common)) return false;
  const bool in_plane = orientation(t[0], t[1], t[2], from) == 0 && orientation(t[0], t[1], t[2], to) == 0;
  if (in_plane) common = first_common(from, to, t, common);
  return true;
}

}  // namespace

bool segment_passes(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept {
  const Heights heights(from, to, t);
  if (!heights.clear) return meets_exactly(from, to, t, common);
  if (!heights.differ()) return false;
  common = heights.tell ? crossing(from, minus(to, from), heights.from, heights.to) : crossing_exactly(from, to, t);
  return true;
}

bool segment_meets(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept {
  // For most segments and triangles, no sign is in doubt in plain double arithmetic.
  const Heights heights(from, to, t);
  if (heights.clear && !heights.differ()) return false;
  const Vec3 way = minus(to, from), a = minus(t[0], from), b = minus(t[1], from), c = minus(t[2], from);
  const double p = dot(way, cross(a, b)), q = dot(way, cross(b, c)), r = dot(way, cross(c, a));
  const double far = max(max(max_abs(a), max_abs(b)), max_abs(c)), size = far * far * max_abs(way);
  const double least = min(min(p, q), r), most = max(max(p, q), r), error = kPlainError * size;
  if (heights.clear && within_range(far * far, size)) {
    if ((least < -error) & (most > error)) return false;
    if ((least > error) | (most < -error)) {
      common = heights.tell ? crossing(from, way, heights.from, heights.to) : crossing_exactly(from, to, t);
      return true;
    }
  }
  return meets_exactly(from, to, t, common);
}

}  // namespace orchard::runtime::detail
