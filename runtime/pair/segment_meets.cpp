#include "segment_meets.h"

#include <algorithm>
#include <cmath>

#include "vector_functions.h"

namespace orchard::runtime::detail {
namespace {

// The plain evaluation below. Differences of the coordinates are right to u = 2^-53 of themselves. Where a, b, c are
// the largest components of three such vectors, a component of the product of the first two is at most 2 a b and off by
// less than 8 u a b, so a triple product is off by less than 3 (8 u + 4 * 2 u) a b c = 48 u a b c, if nothing
// underflows or overflows on the way. That is so where a b and a b c are within kLeast and 1 / kLeast: what underflows
// is below 2^-1074 of a term that then is less than 2^-53 u of a b.
constexpr double kPlainError = 64 * 0x1p-53;
constexpr double kLeast = 0x1p-900;

double largest(const Vec3& v) noexcept { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }

bool within_range(double ab, double abc) noexcept {
  return ab > kLeast && abc > kLeast && ab < 1 / kLeast && abc < 1 / kLeast;
}

Vec3 crossing(const Vec3& from, const Vec3& way, double height_from, double height_to) noexcept {
  const double hp = std::fabs(height_from), hq = std::fabs(height_to);
  return along(from, way, hp + hq > 0 ? std::clamp(hp / (hp + hq), 0.0, 1.0) : 0);
}

// The same by exact signs, and on common planes as triangles_intersect() does it.
bool meets_exactly(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept {
  const int p = orientation(t[0], t[1], t[2], from), q = orientation(t[0], t[1], t[2], to);
  if (p * q > 0) return false;
  if (p == 0 && q == 0) return triangles_intersect({from, to, to}, t, &common);
  const int a = orientation(from, to, t[0], t[1]), b = orientation(from, to, t[1], t[2]);
  if (a * b < 0) return false;
  const int c = orientation(from, to, t[2], t[0]);
  if (a * c < 0 || b * c < 0) return false;
  const Vec3 normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  common = crossing(from, minus(to, from), dot(normal, minus(from, t[0])), dot(normal, minus(to, t[0])));
  return true;
}

}  // namespace

bool segment_meets(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept {
  // Most are plain: no sign is in doubt.
  const Vec3 way = minus(to, from), edge = minus(t[1], t[0]), other = minus(t[2], t[0]), normal = cross(edge, other);
  const Vec3 back = minus(from, t[0]), ahead = minus(to, t[0]);
  const double height_from = dot(normal, back), height_to = dot(normal, ahead);
  const double ab = largest(edge) * largest(other), reach = std::max(largest(back), largest(ahead));
  const Vec3 a = minus(t[0], from), b = minus(t[1], from), c = minus(t[2], from);
  const double p = dot(way, cross(a, b)), q = dot(way, cross(b, c)), r = dot(way, cross(c, a));
  const double far = std::max({largest(a), largest(b), largest(c)}), size = far * far * largest(way);
  const double height_error = kPlainError * ab * reach, error = kPlainError * size;
  const bool heights_clear = std::min(std::fabs(height_from), std::fabs(height_to)) > height_error;
  const double least = std::min({p, q, r}), most = std::max({p, q, r});
  if (heights_clear && within_range(ab, ab * reach) && within_range(far * far, size)) {
    if ((height_from > 0) == (height_to > 0) || (least < -error && most > error)) return false;
    if (least > error || most < -error) {
      common = crossing(from, way, height_from, height_to);
      return true;
    }
  }
  return meets_exactly(from, to, t, common);
}

}  // namespace orchard::runtime::detail
