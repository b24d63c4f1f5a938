#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "orchard/spheretree/union_volume.h"

// The centre of mass and the second moments of a set of balls, and weights of balls that give those of a body.
namespace orchard::detail {

// The integral of x x^T about the centre of mass, divided by the mass.
Eigen::Matrix3d second_moment(const MassProperties& body);

// Balls of the given masses as a rigid body; `volume` is the mass.
MassProperties body_of(std::span<const Sphere> balls, std::span<const double> masses);

struct WeightBounds {
  std::vector<double> wanted, lower, upper;  // of each ball: wanted > 0, lower >= 0, upper >= lower
};

// Returns weights of the balls within the bounds such that the centre of mass and the second moments are those of
// `body` and, with `keep_sum`, the sum of weights is that of `wanted`. Of all such weights, those with the least
// changes relative to `wanted`. If there are none, weights that come nearest to the moments. Uses Newton's method on
// the dual problem, which has ten unknowns for any number of balls.
std::vector<double> weights_with_moments(std::span<const Sphere> balls, const WeightBounds& bounds,
                                         const MassProperties& body, bool keep_sum);

}  // namespace orchard::detail
