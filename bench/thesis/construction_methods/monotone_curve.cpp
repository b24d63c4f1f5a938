#include "monotone_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace orchard::construction_methods {
namespace {

struct Roots {
  std::array<PlanePoint, 2> points;
  int count = 0;
};

// Where the whole circle of `arc` meets the line of `segment`.
Roots line_and_circle(const MonotoneCurve& segment, const MonotoneCurve& arc) {
  const double m = segment.slope, p = segment.x_at(arc.center.y()) - arc.center.x();
  // (p + m u)^2 + u^2 = r^2 with u = y - center.y
  const double a = 1 + m * m, h = p * m, c = (p - arc.radius) * (p + arc.radius), d = h * h - a * c;
  if (!(d > 0)) return {};
  const double root = std::sqrt(d), q = h > 0 ? -h - root : -h + root;
  Roots roots;
  for (const double u : {q / a, q != 0 ? c / q : -q / a})
    roots.points[static_cast<std::size_t>(roots.count++)] = {arc.center.x() + p + m * u, arc.center.y() + u};
  return roots;
}

Roots two_circles(const MonotoneCurve& a, const MonotoneCurve& b) {
  const PlanePoint apart = b.center - a.center;
  const double square = apart.squaredNorm();
  if (square == 0) return {};
  const double along = ((a.radius - b.radius) * (a.radius + b.radius) / square + 1) / 2;
  const double height = a.radius * a.radius / square - along * along;
  if (!(height > 0)) return {};
  const PlanePoint foot = a.center + along * apart, up = std::sqrt(height) * PlanePoint(-apart.y(), apart.x());
  return {{foot + up, foot - up}, 2};
}

bool on_half(const MonotoneCurve& arc, const PlanePoint& p) {
  return arc.side == 0 || (p.x() - arc.center.x()) * arc.side > 0;
}

}  // namespace

double MonotoneCurve::x_at(double y) const {
  const double u = y - center.y();
  if (side == 0) return center.x() + slope * u;
  return center.x() + side * std::sqrt(std::max(0.0, (radius - u) * (radius + u)));
}

double MonotoneCurve::slope_at(double y) const {
  if (side == 0) return slope;
  const double u = y - center.y(), x = std::sqrt(std::max(0.0, (radius - u) * (radius + u)));
  return x > 0 ? -side * u / x : (u < 0 ? side : -side) * std::numeric_limits<double>::infinity();
}

std::optional<double> overtaking(const MonotoneCurve& a, const MonotoneCurve& b) {
  const double low = std::max(a.low, b.low), high = std::min(a.high, b.high);
  if (!(low < high)) return std::nullopt;
  if (a.side == 0 && b.side == 0) {
    const double closing = a.slope - b.slope;
    if (!(closing > 0)) return std::nullopt;
    const double y = low + (b.x_at(low) - a.x_at(low)) / closing;
    return y >= low && y <= high ? std::optional(y) : std::nullopt;
  }
  const Roots roots = a.side == 0 ? line_and_circle(a, b) : b.side == 0 ? line_and_circle(b, a) : two_circles(a, b);
  for (int i = 0; i < roots.count; ++i) {
    const PlanePoint& p = roots.points[static_cast<std::size_t>(i)];
    if (p.y() < low || p.y() > high || !on_half(a, p) || !on_half(b, p)) continue;
    if (a.slope_at(p.y()) > b.slope_at(p.y())) return p.y();
  }
  return std::nullopt;
}

}  // namespace orchard::construction_methods
