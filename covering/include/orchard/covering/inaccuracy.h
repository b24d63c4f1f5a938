#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {

struct Bounds {
  double lower = 0, upper = 0;  // the truth lies between, always
};

// How far apart the two bounds may be: fractions of the bounding radius and of the distance itself, whichever is
// larger.
struct DistanceTolerance {
  double of_radius = tolerance::kInaccuracy;
  double of_distance = 0.01;
};

// Bounds on Hubbard's inaccuracy of a sphere: the largest distance to the surface from a point of the sphere's surface
// that lies outside the solid, 0 if there is none (dissertation 5.3.2, 5.3.5). Lemma 5.1 holds for convex objects only,
// so this is a branch and bound over the sphere: the distance is 1-Lipschitz. Lengths in mesh units; the bounds are as
// near as asked for, but no nearer than 1e-6 R, unless the work limit is met. Throws InputError unless surface.solid().
Bounds inaccuracy(const Surface& surface, const Sphere& sphere, const DistanceTolerance& tolerance = {});

// Bounds on the largest distance to the solid from a point of the closed ball, 0 if the ball lies inside: what the
// run-time's bound on separation is made of. Unlike the inaccuracy it counts the ball's inside too, which matters where
// a ball fills a hole or a gap. A branch and bound over cubes; width and errors as for inaccuracy(). The upper bound is
// never above distance_bound(). Faster with a lower bound that is known already, such as the inaccuracy's.
Bounds farthest_from_solid(const Surface& surface, const Sphere& ball, const DistanceTolerance& tolerance = {},
                           double at_least = 0);

// The same, only as far as it takes to tell whether the distance is at most `limit`: then upper <= limit; else lower >
// limit, and `at` is a point of the ball that far away. Where neither holds, the work limit was met.
Bounds farthest_against(const Surface& surface, const Sphere& ball, double limit, Point& at);

// An upper bound on the largest distance to the solid from any point of the closed ball: max(0, radius + signed
// distance of the centre), rounded upward. Holds for every solid, convex or not, since the signed distance is
// 1-Lipschitz.
double distance_bound(double signed_distance_of_center, double radius);

}  // namespace orchard
