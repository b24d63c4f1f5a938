#include "overlap.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

namespace orchard {
namespace {

using Rational = boost::multiprecision::cpp_rational;

constexpr int kHalvings = 60;
constexpr double kRoundedDown = 1 - 0x1p-45;

// For two balls whose spheres meet, lens() and whole() are the volumes of their intersection and of the smaller ball,
// both times the same factor (12 distance / pi). See Weisstein, "Sphere-Sphere Intersection".
template <class Number>
Number lens(const Number& distance, const Number& large, const Number& small) {
  const Number sum = large + small, difference = large - small, gap = sum - distance;
  return gap * gap * (distance * distance + 2 * distance * sum - 3 * difference * difference);
}
template <class Number>
Number whole(const Number& distance, const Number& small) {
  return 16 * distance * small * small * small;
}

double share_at(double distance, double a, double b) {
  const double large = std::max(a, b), small = std::min(a, b);
  if (distance >= large + small) return 0;
  if (distance <= large - small) return 1;
  return lens(distance, large, small) / whole(distance, small);
}

}  // namespace

double overlap_share(const Sphere& a, const Sphere& b) {
  return share_at((a.center - b.center).norm(), a.radius, b.radius);
}

bool overlaps_at_most(const Sphere& a, const Sphere& b, double share) {
  if (share >= 1) return true;
  Rational squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Rational along = Rational(a.center[axis]) - Rational(b.center[axis]);
    squared += along * along;
  }
  const Rational large(std::max(a.radius, b.radius)), small(std::min(a.radius, b.radius));
  const Rational sum = large + small, difference = large - small;
  if (squared >= sum * sum) return true;
  if (!(share > 0)) return false;
  const Rational distance((a.center - b.center).norm() * kRoundedDown);
  if (distance * distance > squared || distance <= difference) return false;
  return lens(distance, large, small) <= Rational(share) * whole(distance, small);
}

double detail::contact_distance(double a, double b, double share) {
  if (!(share > 0)) return a + b;
  double low = std::abs(a - b), high = a + b;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (share_at(middle, a, b) > share ? low : high) = middle;
  }
  return share >= 1 ? 0 : high;
}

double detail::allowed_radius(double distance, double other, double share, double limit) {
  if (share_at(distance, limit, other) <= share) return limit;
  if (!(share > 0)) return std::max(0.0, distance - other);
  double low = std::max(0.0, distance - other), high = limit;
  if (low == 0) return 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (share_at(distance, middle, other) > share ? high : low) = middle;
  }
  return low;
}

}  // namespace orchard
