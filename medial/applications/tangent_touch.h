#pragma once
#include <array>
#include <limits>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of a surface, and the balls that touch the surface there from inside: those with centre p - r n and radius r.
// Such a ball may grow until it meets the surface at a place q that, seen from its centre, is at least as far from p as
// a smooth surface may turn: n (p - q) >= sine |p - q|. This condition does not depend on r: the places q that fulfil
// it form a convex cone with its apex at p.
struct TangentPlace {
  Point position = Point::Zero();
  Vector normal = Vector::Zero();  // unit, outward
  double sine = 0;                 // of half the turn, in (0, 1)
};

// The smallest of these balls that meets something in the cone, and where it does.
struct Touch {
  double radius = std::numeric_limits<double>::infinity();  // infinite: none does
  Point at = Point::Zero();
};

// The smallest of these balls that meets a triangle in the cone, exact up to a few roundings: its radius is the least
// |p - q|^2 / (2 n (p - q)) over the points q of the triangle in the cone. `normal`: the triangle's unit normal, or
// zero if the triangle is degenerate. A ball that is no smaller than `limit`, which may be infinite, need not be found.
Touch touch_of_triangle(const TangentPlace& place, const std::array<Point, 3>& corners, const Vector& normal,
                        double limit);

// Where the ray from p along -n meets a triangle. The touch's radius is half the distance along the ray.
Touch ray_through_triangle(const TangentPlace& place, const std::array<Point, 3>& corners, const Vector& normal);

// How steeply a triangle goes down from a place p of its own (`feature`: a corner, an edge or the face): the largest
// -n w over the unit directions w that lead from p into the triangle. If it is above `sine`, the ball at p has radius
// 0; if not, no place of the triangle is in the cone.
double descent_at(const Vector& place_normal, const std::array<Point, 3>& corners, const Vector& normal,
                  Feature feature);

}  // namespace orchard::detail
