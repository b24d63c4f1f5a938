#include <algorithm>
#include <cmath>

#include "bound.h"

// Face-plane and plane-plane intersections (dissertation 4.2.6, 4.2.7).
namespace orchard::broad_phase_methods {
namespace {

constexpr double kParallel = 1e-5;  // sine of the angle below which two planes' line is too ill-conditioned to use

// The half-space x . normal <= constant + change t of points x; its boundary is a plane that moves steadily.
struct HalfSpace {
  Vec3 normal;
  double constant, change;
};

Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A bound as an intersection of half-spaces, seen from `origin`: six for the cubes, and the cutting plane.
struct HalfSpaces {
  std::array<HalfSpace, 7> all;
  std::size_t count = 6;

  HalfSpaces(const SpaceTimeBound& bound, const Vec3& origin, double slack) noexcept {
    const Vec3 center = bound.center - origin;
    for (std::size_t i = 0; i < 6; ++i) {
      Vec3 normal{};
      normal[i / 2] = i % 2 == 0 ? 1 : -1;
      all[i] = {normal, dot(normal, center) + bound.size + slack, dot(normal, bound.velocity) + bound.slope};
    }
    if (bound.has_plane()) {
      all[count++] = {bound.normal, dot(bound.normal, center) + bound.cut + slack,
                      dot(bound.normal, bound.velocity) + bound.cut_growth};
    }
  }
};

// A linear program in two variables, solved by eliminating k: least t in [first, last] with an allowed k, or
// kNoContact.
class LineProgram {
 public:
  LineProgram(double first, double last) noexcept : first_(first), last_(last) {}

  void require(double k, double t, double at_most) noexcept {  // k * K + t * T <= at_most
    constexpr double kNone = 1e-12;                            // of a unit normal's component along the line
    if (k > kNone) {
      upper_[uppers_++] = {at_most / k, -t / k};
    } else if (k < -kNone) {
      lower_[lowers_++] = {at_most / k, -t / k};
    } else {
      require_time(t, at_most);
    }
  }

  double least() noexcept {
    for (std::size_t i = 0; i < lowers_; ++i) {
      for (std::size_t j = 0; j < uppers_; ++j) {
        require_time(lower_[i].slope - upper_[j].slope, upper_[j].constant - lower_[i].constant);
      }
    }
    return first_ <= last_ ? first_ : kNoContact;
  }

 private:
  struct Line {
    double constant, slope;
  };
  void require_time(double t, double at_most) noexcept {  // t * T <= at_most
    if (t > 0) {
      last_ = std::min(last_, at_most / t);
    } else if (t < 0) {
      first_ = std::max(first_, at_most / t);
    } else if (at_most < 0) {
      last_ = -kNoContact;
    }
  }
  std::array<Line, 14> upper_{}, lower_{};
  std::size_t uppers_ = 0, lowers_ = 0;
  double first_, last_;
};

struct Pair {
  const SpaceTimeBound &a, &b;
  const HalfSpaces &of_a, &of_b;
  double first, last, slack;
};

bool meet_within(const SpaceTimeBound& a, const SpaceTimeBound& b, double t, double slack) noexcept;

// When two boundaries, one of each bound, first meet in a point of both bounds.
double boundaries_meet(const Pair& pair, std::size_t i, std::size_t j) noexcept {
  const HalfSpace &p = pair.of_a.all[i], &q = pair.of_b.all[j];
  const Vec3 along = cross(p.normal, q.normal);
  const double square = dot(along, along);
  if (square == 0) {  // parallel: they meet as a whole if they face each other, and at one time
    const double change = p.change + q.change, gap = -(p.constant + q.constant);
    if (dot(p.normal, q.normal) > 0 || !(change > 0)) return kNoContact;
    const double t = std::max(pair.first, gap / change);
    return t <= pair.last && meet_within(pair.a, pair.b, t, 2 * pair.slack) ? t : kNoContact;
  }
  if (square < kParallel * kParallel) return pair.first;  // too early at worst

  // The line of intersection is start + t way + k along (Equation 4.12).
  const Vec3 u = (1 / square) * cross(q.normal, along), v = (1 / square) * cross(along, p.normal);
  const Vec3 start = p.constant * u + q.constant * v, way = p.change * u + q.change * v;
  LineProgram program(pair.first, pair.last);
  for (const HalfSpaces* side : {&pair.of_a, &pair.of_b}) {
    for (std::size_t h = 0; h < side->count; ++h) {
      if ((side == &pair.of_a && h == i) || (side == &pair.of_b && h == j)) continue;
      const HalfSpace& half = side->all[h];
      program.require(dot(along, half.normal), dot(way, half.normal) - half.change,
                      half.constant - dot(start, half.normal));
    }
  }
  return program.least();
}

// Do cubes and cutting planes, all moved outward by `slack`, have a common point at t?
bool meet_within(const SpaceTimeBound& a, const SpaceTimeBound& b, double t, double slack) noexcept {
  const Vec3 ca = a.center_at(t), cb = b.center_at(t);
  const double ha = a.trapezoid_half(t) + slack, hb = b.trapezoid_half(t) + slack;
  Vec3 lower, upper;
  for (std::size_t i = 0; i < 3; ++i) {
    lower[i] = std::max(ca[i] - ha, cb[i] - hb);
    upper[i] = std::min(ca[i] + ha, cb[i] + hb);
    if (lower[i] > upper[i]) return false;
  }
  // Empty exactly if some mixture of the two half-spaces excludes the whole box. How far the box's best corner lies
  // outside is concave and piecewise linear in the mixture; it bends where a component of the normal changes sign.
  const double limit_a = dot(a.normal, ca) + a.cut + t * a.cut_growth + slack;
  const double limit_b = dot(b.normal, cb) + b.cut + t * b.cut_growth + slack;
  const auto excluded = [&](double share) {
    const Vec3 normal = share * a.normal + (1 - share) * b.normal;
    double least = 0;
    for (std::size_t i = 0; i < 3; ++i) least += std::min(normal[i] * lower[i], normal[i] * upper[i]);
    return least > share * limit_a + (1 - share) * limit_b;
  };
  if (a.has_plane() && excluded(1)) return false;
  if (b.has_plane() && excluded(0)) return false;
  if (!a.has_plane() || !b.has_plane()) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = b.normal[i] / (b.normal[i] - a.normal[i]);
    if (share > 0 && share < 1 && excluded(share)) return false;
  }
  return true;
}

}  // namespace

bool cut_cubes_meet(const SpaceTimeBound& a, const SpaceTimeBound& b, double t) noexcept {
  return meet_within(a, b, t, detail::contact_slack(a, b, t));
}

namespace detail {

double plane_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double first, double duration) noexcept {
  const double slack = contact_slack(a, b, duration);
  const HalfSpaces of_a(a, a.center, slack), of_b(b, a.center, slack);
  const Pair pair{a, b, of_a, of_b, first, duration, slack};
  double contact = kNoContact;
  const std::size_t plane = 6;
  if (b.has_plane()) {
    for (std::size_t face = 0; face < 6; ++face) contact = std::min(contact, boundaries_meet(pair, face, plane));
  }
  if (a.has_plane()) {
    for (std::size_t face = 0; face < 6; ++face) contact = std::min(contact, boundaries_meet(pair, plane, face));
  }
  if (a.has_plane() && b.has_plane()) contact = std::min(contact, boundaries_meet(pair, plane, plane));
  return contact;
}

}  // namespace detail
}  // namespace orchard::broad_phase_methods
