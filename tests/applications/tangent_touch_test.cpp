// The smallest ball at a place that touches one triangle.
#include "applications/tangent_touch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

TEST(TangentTouch, IsTheSameForEveryLimitAboveIt) {
  // The triangle is entirely below its first corner, which lies straight below the place: the ball stands on it.
  const TangentPlace place{Point::Zero(), Vector(1, 1, 1).normalized(), 0.5};
  const Point a(-1.2, -1.2, -1.2), b = a + Vector(-1, -2, -3), c = a + Vector(-2, -1, -4);
  const Vector normal = (b - a).cross(c - a).normalized();
  for (const double limit : {1.04, 10.0, 1e300, std::numeric_limits<double>::infinity()}) {
    const Touch touch = touch_of_triangle(place, {a, b, c}, normal, limit);
    EXPECT_NEAR(touch.radius, 0.6 * std::sqrt(3), 1e-12) << limit;
    EXPECT_LT((touch.at - a).norm(), 1e-12) << limit;
  }
}

}  // namespace
}  // namespace orchard::detail
