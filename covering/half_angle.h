#pragma once
#include <cmath>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Half of an angle between 0 and pi, as its sine and cosine. It gives sums and chords of such angles without calls of
// trigonometric functions and without cancellation.
struct HalfAngle {
  double sin = 0, cos = 1;

  // Returns half the angle between two vectors of these lengths; 0 if one of the lengths is 0.
  static HalfAngle between(const Vector& a, double a_length, const Vector& b, double b_length) {
    const double dot = a.dot(b), cross = a.cross(b).norm(), product = a_length * b_length;
    if (!(product > 0)) return {};
    const double larger = std::sqrt((product + std::abs(dot)) / (2 * product));
    const double smaller = cross / (2 * product * larger);
    return dot >= 0 ? HalfAngle{smaller, larger} : HalfAngle{larger, smaller};
  }
  // Returns half the angle that has this sine and is at most a right angle.
  static HalfAngle of_sine(double sine) {
    const double cosine = std::sqrt((1 - sine) * (1 + sine)), half = std::sqrt((1 + cosine) / 2);
    return {sine / (2 * half), half};
  }

  // Returns half the chord of the sum of both angles on the unit circle; 1 if the sum is at least pi.
  double half_chord_with(const HalfAngle& other) const {
    return cos * other.cos > sin * other.sin ? sin * other.cos + cos * other.sin : 1;
  }
};

}  // namespace orchard::detail
