#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "orchard/spheretree/union_volume.h"

// Centre of mass and second moments of a set of balls, and weights with which these are a given body's.
namespace orchard::detail {

// The integral of x x^T about the centre of mass, over the mass.
Eigen::Matrix3d second_moment(const MassProperties& body);

// Balls of the given masses as a rigid body; `volume` is the mass.
MassProperties body_of(std::span<const Sphere> balls, std::span<const double> masses);

struct WeightBounds {
  std::vector<double> wanted, lower, upper;  // of each ball; above 0, at least 0, not below `lower`
};

// Weights of the balls between the bounds, with which the centre of mass and the second moments are those of `body`,
// and, if `keep_sum`, the sum is that of `wanted`: as near as can be to `wanted`, relative to it. Where there are none,
// weights that come as near to the moments as can be. Newton's method on the dual, ten numbers however many balls there
// are.
std::vector<double> weights_with_moments(std::span<const Sphere> balls, const WeightBounds& bounds,
                                         const MassProperties& body, bool keep_sum);

}  // namespace orchard::detail
