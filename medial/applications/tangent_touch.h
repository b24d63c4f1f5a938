#pragma once
#include <array>
#include <limits>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of a surface, and the balls that touch the surface there from inside: those with centre p - r n and radius r.
// A ball ends where it meets the surface at a place q that is seen from its centre at least as far from p as the turn
// of a smooth surface: n (p - q) >= sine |p - q|. Whether that is so does not depend on r, so that these q are a convex
// cone with its apex at p.
struct TangentPlace {
  Point position = Point::Zero();
  Vector normal = Vector::Zero();  // unit, outward
  double sine = 0;                 // of half the turn, in (0, 1)
};

// Where the smallest of these balls that touches something touches it.
struct Touch {
  double radius = std::numeric_limits<double>::infinity();  // infinite: none does
  Point at = Point::Zero();
};

// The ball that touches a triangle from inside, exact up to a few roundings: the least |p - q|^2 / (2 n (p - q)) over
// the part of the triangle that is in the cone. `normal`: the triangle's, unit length; zero if it is degenerate. A ball
// that is no smaller than `limit` need not be found.
Touch touch_of_triangle(const TangentPlace& place, const std::array<Point, 3>& corners, const Vector& normal,
                        double limit = std::numeric_limits<double>::infinity());

// Where the ray from p along -n meets a triangle, as a touch with half the way as its radius.
Touch ray_through_triangle(const TangentPlace& place, const std::array<Point, 3>& corners, const Vector& normal);

// How steeply a triangle goes down from a place p that is a corner of it (Feature::vertex0..), on an edge of it or on
// its face: the largest -n w over the unit directions w in which it goes on from p. A ball that touches at p cannot be
// larger than nothing if that is above `sine`; if not, the triangle has no place in the cone.
double descent_at(const Vector& place_normal, const std::array<Point, 3>& corners, const Vector& normal,
                  Feature feature);

}  // namespace orchard::detail
