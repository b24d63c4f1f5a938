#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "orchard/geometry/surface.h"

namespace orchard {

// A number that was estimated from samples.
struct Estimate {
  double value = 0;
  double error = 0;  // one standard error of the value
};

// A homogeneous solid of density 1.
struct MassProperties {
  double volume = 0;                                  // cubic mesh units
  Point center = Point::Zero();                       // of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the centre of mass
};

// How a union of balls and a solid differ as bodies. Volumes in cubic mesh units.
struct UnionVolume {
  Estimate balls;      // of the union of the balls
  Estimate outside;    // of its part outside the solid
  Estimate uncovered;  // of the solid's part outside the union
  double solid = 0;    // of the solid: exact where it does not cut itself, else an estimate
  MassProperties of_balls, of_solid;
};

// Measures the union of balls beside a solid by parallel rays, exactly along each, in eight independent sets whose
// differences give the errors. With the standard number the errors are about 0.1 % of the volumes; with fewer rays they
// grow about as their number falls. The time is that of outside_volume() with as many rays. Throws InputError unless
// surface.solid().
UnionVolume union_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t rays = 40'000);

// Mass properties of the solid by the divergence theorem: exact, but parts that the surface winds around twice count
// twice. Precondition: surface.solid().
MassProperties mass_properties(const Surface& surface);

// |a - b| / |b| of two inertia tensors (Frobenius), each about its own centre of mass: at equal density, or with `a`
// scaled to the mass of `b`.
double inertia_difference(const MassProperties& a, const MassProperties& b, bool equal_mass);

}  // namespace orchard
